// The engines by name; include/duoptic/engine.h is what others see.
#pragma once

#include <memory>

#include "duoptic/engine.h"

namespace duo {

std::unique_ptr<Engine> make_ref_engine();
std::unique_ptr<Engine> make_simd_engine(int threads);

}  // namespace duo
