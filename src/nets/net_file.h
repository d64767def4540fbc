// Reads the files of networks that tools/models/make writes.
//
// All numbers little-endian; a name is padded with zeros.
//   "DUONET1\n"                    8 bytes
//   hash of all that follows       u64: FNV-1a over 64-bit words
//   name                           24 bytes
//   tensors, layers, outputs, 0    4 u32
//   for each tensor: height, width, channels u16; exponent, low, high i16
//   for each layer: a, b, y u16 (b 0xFFFF: none); kind, window, stride, top, left, left a, left b, shift, fold, 0 u8; at u32
//   for each output: name 14 bytes, tensor u16
//   zeros to a multiple of 8, then the constants: a layer's begin at byte `at`: weights i16, bias i32, shifts u8, each padded
//   with zeros to a multiple of 8
#pragma once

#include <filesystem>
#include <string_view>

#include "duoptic/result.h"
#include "nets/net.h"

namespace duo {

/// A network of bytes that anybody may have written. What it gives can be run: sizes fit together, no sum of a layer leaves 32
/// bits, all tensors together are below 256 MiB. `name` is for messages.
///
/// Errors  not such a file, cut, changed (its hash), made by another version, a layer that cannot be run
Result<Net> parse_net(std::string_view bytes, std::string_view name);

/// Errors  those of parse_net(); not there, not readable
Result<Net> read_net(const std::filesystem::path& path);

/// FNV-1a over 64-bit words; what is left is padded with zeros.
std::uint64_t hash_words(std::string_view bytes);

}  // namespace duo
