// The version of these headers; CMakeLists.txt reads it from here. While the first number is 0, programs must be compiled anew
// for another second number.
#pragma once

#define DUOPTIC_VERSION_MAJOR 0
#define DUOPTIC_VERSION_MINOR 1
#define DUOPTIC_VERSION_PATCH 0

namespace [[gnu::visibility("default")]] duo {

/// The version of the library that the program runs with: "0.1.0".
const char* version();

}  // namespace duo
