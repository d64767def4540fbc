// Included by C++ and by GLSL: what matching makes of clear pictures, which are finely resolved and without noise, and of
// others, and how the pairs of a stream settle whether theirs are.
#ifndef DUO_STAGES_TYPES_CLEAR_H
#define DUO_STAGES_TYPES_CLEAR_H
#ifdef __cplusplus
namespace duo {
#define DUO_INLINE inline
#else
#define DUO_INLINE
#endif

const int kClearBlur_q4 = 30;      // a pair below, and without noise, says that its pictures are clear
const int kClearPatience = 30;     // pairs in a row that must say otherwise before a stream believes them
const int kClearGrayDeadZone = 3;  // gray levels by which two cameras see a surface differently
const int kClearUnbalanced = 8;    // and by which a balance may be wrong where there is little to balance
const int kHiddenNoise_q4 = 4;     // of other pictures at least, 1/16 gray levels: compression hides it where it is measured

// What a stream knows after one more pair: above 0 its pictures are clear, 0 is a stream before its first pair. The first pair
// decides; later ones only when kClearPatience of them in a row disagree, so that a stream near the border does not flicker.
DUO_INLINE int next_clear(int known, bool pair_is_clear) {
  const int certain = pair_is_clear ? kClearPatience : -kClearPatience;
  if (known == 0 || (known > 0) == pair_is_clear) return certain;
  const int doubting = known > 0 ? known - 1 : known + 1;
  return doubting == 0 ? certain : doubting;
}

// What counts of a measured noise.
DUO_INLINE int counted_noise_q4(bool clear, int noise_q4) {
  return clear || noise_q4 > kHiddenNoise_q4 ? noise_q4 : kHiddenNoise_q4;
}

// The least penalty of a larger step of disparity. In compressed pictures it is p2 everywhere: their edges are wide, and many
// of them are no edge of a surface. Where noise shows that is worth less, and from 2 1/4 gray levels on it is not so.
DUO_INLINE int least_p2(bool clear, int noise_q4, int p2, int p2_least) {
  const int shows = 36;
  if (clear || noise_q4 >= shows) return p2_least;
  return p2_least + (p2 - p2_least) * (shows - counted_noise_q4(clear, noise_q4)) / (shows - kHiddenNoise_q4);
}

#undef DUO_INLINE
#ifdef __cplusplus
}  // namespace duo
#endif
#endif
