// The histogram loops of SIFT with vectors.
#pragma once

#include "stages/sift/kernels.h"

namespace duo::sift {

decltype(Kernels::directions) directions_simd();
decltype(Kernels::cells) cells_simd();

}  // namespace duo::sift
