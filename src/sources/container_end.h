// Whether bytes are missing at the end of a video file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace duo {

/// By the sizes that AVI (RIFF) and Matroska (EBML) write before their content: true where the file has fewer bytes. Empty
/// where the container has no such size, or was never given one because its writer was ended.
std::optional<bool> lacks_bytes(const std::filesystem::path& path);

}  // namespace duo
