// Pictures as PNG and JPEG files have them.
#pragma once

#include <cstdint>
#include <string>

#include "duoptic/image.h"

namespace duo {

/// A picture as PNG, without loss: coloured, gray, or gray of 16 bits. The same bytes each time;
/// the chunk after the header, pHYs, says that pixels are square.
///
/// Errors  empty when the picture is, or when it has more than libav's PNG can hold; std::bad_alloc
std::string png_of(View<const Rgb8> picture);
std::string png_of(View<const std::uint8_t> picture);
std::string png_of(View<const std::uint16_t> picture);

/// A picture as JPEG with its colours at half its size.
///
/// quality  1 .. 100, as libjpeg counts
/// Errors   empty when the picture is, or has more than 65500 pixels a side
std::string jpeg_of(View<const Rgb8> picture, int quality);

}  // namespace duo
