// Whether two pictures show the same thing.
#pragma once

#include <cstdint>

#include "duoptic/image.h"

namespace duo {

enum class SameScene : std::uint8_t {
  kYes,
  kNo,
  kUnknown,  // too little texture to tell
};

/// Looks for patches of the left picture in the right one, on rows up to an eighth of the height away, and for what was found
/// in the left one again. Of two views of one scene a good part comes back to where it began; of others next to nothing.
/// Brightness and contrast may differ.
///
/// Shape   both of one size; they are looked at with 160 columns
SameScene show_the_same(View<const Rgb8> left, View<const Rgb8> right);

}  // namespace duo
