// Writing what was found: each call writes one whole file or leaves nothing under its name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "duoptic/frame.h"
#include "duoptic/result.h"
#include "duoptic/rig.h"

namespace duo {

/// Disparity as a PFM of float px, +infinity where there is none (Middlebury's convention).
Result<void> write_pfm(View<const std::uint16_t> d_q4, const std::filesystem::path& path);
/// Reads a one-channel PFM, either byte order; rows top to bottom.
Result<Image<float>> read_pfm(const std::filesystem::path& path);
/// The same for bytes already in memory; `name` stands for them in messages.
Result<Image<float>> parse_pfm(std::string_view bytes, const std::string& name);

/// Disparity as colours: the Turbo map (Mikhailov 2019), near is red, none is black, with a legend; the legend is in
/// metres when `rectified` is given, else in px. The range of the colours is the 1st to 99th percentile of the valid pixels.
Image<Rgb8> draw_disparity(View<const std::uint16_t> d_q4, const Rectified* rectified);

Result<void> write_png(View<const Rgb8> picture, const std::filesystem::path& path);
Result<void> write_png(View<const std::uint8_t> picture, const std::filesystem::path& path);
Result<void> write_png(View<const std::uint16_t> picture, const std::filesystem::path& path);

/// Coloured points of all pixels with a depth, in metres in the rig frame: binary little-endian PLY, x y z float, red green
/// blue uchar.
Result<void> write_ply(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified,
                       const std::filesystem::path& path);

/// The cloud drawn from a camera moved sideways and up, so that a person sees its shape without a 3D program.
Image<Rgb8> draw_cloud(View<const std::uint16_t> d_q4, View<const Rgb8> color, const Rectified& rectified, Size size);

}  // namespace duo
