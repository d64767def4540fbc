// What a picture's bytes say before they are decoded: where a JPEG ends, its parts, orientation, and what no decoder here
// reads.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "duoptic/source.h"
#include "sources/orientation.h"

namespace duo {

bool is_jpeg(std::string_view bytes);

/// Length of the JPEG that `bytes` begin with; npos where its end is not among them.
std::size_t jpeg_length(std::string_view bytes);

/// True where another JPEG follows the first, and the first does not say what that is: a video.
bool is_jpeg_sequence(std::string_view bytes);

/// The two views of an MPO (CIPA DC-007), left first; empty where `bytes` are none. Panoramas, previews and the gain maps of
/// phones are no views.
std::vector<std::string_view> views_of_mpo(std::string_view bytes);

/// How many pictures a TIFF (its smaller copies do not count), a PNG (moving ones) or a PNM (P5, P6) holds one after the other;
/// 1 of other kinds, and where it cannot be told.
int pictures_held(std::string_view bytes);

/// The orientation that a JPEG, PNG, WebP or TIFF asks for.
Orientation orientation_of(std::string_view bytes);

/// The layout that a JPS says in its marker; by the format's habit the right view comes first.
std::optional<ViewLayout> layout_of_jps(std::string_view bytes, bool named_jps);

/// Standard deviation of what rounding a JPEG's coefficients of brightness adds to each pixel, in 1/16 gray levels; 0 where
/// `bytes` are none, or have no table of steps before their first scan.
///
/// A coefficient that is rounded to multiples of q is off by q / sqrt(12) in the mean, and a pixel is the sum of 64 of them,
/// each over 8. The ten lowest count: most of the others are zero before and after. The table is that of the first component.
///
/// Source   ITU-T T.81, A.3.4 (rounding), B.2.2 (which table), B.2.4.1 (table)
int coding_noise_q4(std::string_view bytes);
/// Gives a picture the bytes of its JPEG and their coding noise; of no bytes, neither.
void put_jpeg(std::string_view bytes, Picture& into);

/// "" or what the picture has that is not read: an unsupported kind is not a damaged file.
std::string unsupported_in(std::string_view bytes);

/// A kind of files of which nothing is read, told by its first bytes.
struct ForeignKind {
  std::string_view name;    // "a HEIC file"
  std::string_view advice;  // what makes a file of it that is read
};
std::optional<ForeignKind> foreign_kind(std::string_view head);

}  // namespace duo
