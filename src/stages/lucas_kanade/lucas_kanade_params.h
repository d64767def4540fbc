// Included by C++ and by GLSL: the numbers of duo::LucasKanade, and what a gradient counts for.
#ifndef DUO_LUCAS_KANADE_PARAMS_H
#define DUO_LUCAS_KANADE_PARAMS_H
#include "vulkan/plane.h"
#ifdef __cplusplus
#define DUO_INLINE constexpr
namespace duo {
#else
#define DUO_INLINE
#endif

const int kLucasKanadeReach = 6;           // taps of the window to each side
const int kLucasKanadeMostDifference = 8;  // gray levels
const int kLucasKanadeMost_q4 = 6;         // 1/16 px

// g w in 1/2^14, of g >= 0 in 1/4: at most 181, so that with e of 1/16 a pull fits 16 bits.
DUO_INLINE int lucas_kanade_pull(int g_q2) {
  const int most = g_q2 * g_q2 + 128;
  return (4096 * g_q2 + most / 2) / most;
}

// g^2 w + 1/20 in 2/5 of 1/1024: so the quotient of the sums is two and a half steps in 1/16 px.
DUO_INLINE int lucas_kanade_weight(int g_q2) {
  const int square = g_q2 * g_q2, most = square + 128;
  return (410 * square + most / 2) / most + 20;
}

#undef DUO_INLINE
#ifdef __cplusplus
namespace vk {
#endif

struct LucasKanadePush {
  Plane left, right, d_q4, dst;
  int width, height, most_q4;  // most_q4: the largest disparity
};

#ifdef __cplusplus
}  // namespace vk
}  // namespace duo
#endif
#endif
