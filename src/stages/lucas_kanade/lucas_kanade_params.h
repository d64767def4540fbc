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

// w in 4/9 of 1/2^19, of g >= 0: at most 29120, so that it fits 15 bits.
DUO_INLINE int lucas_kanade_inverse(int g_q2) {
  const int most = g_q2 * g_q2 + 128;
  return ((455 << 13) + most / 2) / most;
}

// l r w + 1/20 in 4/9 of 1/1024: so the quotient of the sums is two and a quarter steps in 1/16 px. l r in 1/16 is not below 0,
// and not above g^2.
DUO_INLINE int lucas_kanade_weight(int lr_q4, int inverse) { return ((lr_q4 * inverse + (1 << 12)) >> 13) + 23; }

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
