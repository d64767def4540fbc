// A picture file as a source of one picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "duoptic/source.h"

namespace duo {

/// How many leading bytes of a file is_picture() wants to see.
inline constexpr std::size_t kPictureMagicBytes = 24;

/// True for PNG, JPEG, BMP, TIFF, WebP and PNM, told by their first bytes.
bool is_picture(std::string_view head);

/// Reads the picture whole: gray and 16 bits become 8-bit RGB, alpha is dropped, and it is put upright as its EXIF asks, as
/// OpenCV does, too. `view`: of an MPO, 0 or 1.
///
/// Errors  cut short or damaged anywhere; kind of pixels not supported
Result<std::unique_ptr<Source>> open_picture(const std::filesystem::path& path, int view = 0);

}  // namespace duo
