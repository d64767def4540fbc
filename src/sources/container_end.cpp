#include "sources/container_end.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "core/file.h"

namespace duo {
namespace {

/// `size` bytes at `at` as a whole number; empty beyond the end.
std::optional<std::uint64_t> whole_number_at(int file, std::uint64_t at, int size, bool little) {
  std::uint8_t bytes[8] = {};
  if (::pread(file, bytes, static_cast<std::size_t>(size), static_cast<off_t>(at)) != size) return std::nullopt;
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes[little ? size - 1 - i : i];
  return value;
}

/// One RIFF follows the other where a file is long.
std::optional<bool> riff_lacks_bytes(int file, std::uint64_t file_bytes) {
  constexpr std::uint64_t kRiff = 0x52494646, kNotWritten = 0xffffffff;
  constexpr std::uint64_t kCountedTwice = 8;  // some writers count the head, too
  std::optional<bool> lacks;
  for (std::uint64_t at = 0; whole_number_at(file, at, 4, false) == kRiff;) {
    const auto size = whole_number_at(file, at + 4, 4, true);
    if (!size || *size == 0 || *size == kNotWritten) return std::nullopt;
    at += 8 + *size;
    lacks = at > file_bytes + kCountedTwice;
    at += *size % 2;
  }
  return lacks;
}

/// An EBML number: the first byte's leading zeros tell how many more there are.
std::optional<std::uint64_t> ebml_number(int file, std::uint64_t& at, bool is_id) {
  const auto first = whole_number_at(file, at, 1, false);
  if (!first || *first == 0) return std::nullopt;
  const int size = std::countl_zero(static_cast<std::uint8_t>(*first)) + 1;
  const auto value = whole_number_at(file, at, size, false);
  at += static_cast<std::uint64_t>(size);
  const std::uint64_t all = (std::uint64_t{1} << 7 * size) - 1;
  if (!value || is_id) return value;
  return (*value & all) == all ? std::numeric_limits<std::uint64_t>::max() : *value & all;  // not written
}

/// Elements of an unknown size hold what follows; of all others the end is known.
std::optional<bool> ebml_lacks_bytes(int file, std::uint64_t file_bytes) {
  constexpr std::uint64_t kHead = 0x1a45dfa3, kSegment = 0x18538067, kCluster = 0x1f43b675;
  if (whole_number_at(file, 0, 4, false) != kHead) return std::nullopt;
  for (std::uint64_t at = 0; at != file_bytes;) {
    const auto id = ebml_number(file, at, true);
    const auto size = id ? ebml_number(file, at, false) : std::nullopt;
    constexpr std::uint64_t kMostOfHead = 12;
    if (!id || !size) return at + kMostOfHead > file_bytes ? std::optional(true) : std::nullopt;
    const bool unknown = *size == std::numeric_limits<std::uint64_t>::max();
    if (unknown && *id != kSegment && *id != kCluster) return std::nullopt;
    if (unknown) continue;
    const bool lacks = *size > file_bytes - std::min(at, file_bytes);
    if (lacks || *id == kSegment) return lacks;
    at += *size;
  }
  return false;
}

}  // namespace

std::optional<bool> lacks_bytes(const std::filesystem::path& path) {
  const auto file = open_file(path, std::numeric_limits<std::size_t>::max(), "video");
  if (!file) return std::nullopt;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return std::nullopt;
  const auto riff = riff_lacks_bytes(file->get(), bytes);
  return riff ? riff : ebml_lacks_bytes(file->get(), bytes);
}

}  // namespace duo
