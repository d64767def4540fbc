// SHA-256 (FIPS 180-4) of texts and files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "duoptic/result.h"

namespace duo {

/// 64 lowercase hexadecimal digits.
std::string sha256(std::string_view text);

/// Of a file's bytes. `sync`: they are on the disk before. `read` is told how many bytes were read each time.
///
/// Errors  those of open_file(); reading fails
Result<std::string> sha256_of(const std::filesystem::path& path, bool sync = false,
                              const std::function<void(std::int64_t)>& read = {});

}  // namespace duo
