// Included by C++ and by GLSL: what matching makes of clear pictures, which are finely resolved and without noise, and how the
// pairs of a stream settle whether theirs are.
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

// What a stream knows after one more pair: above 0 its pictures are clear, 0 is a stream before its first pair. The first pair
// decides; later ones only when kClearPatience of them in a row disagree, so that a stream near the border does not flicker.
DUO_INLINE int next_clear(int known, bool pair_is_clear) {
  const int certain = pair_is_clear ? kClearPatience : -kClearPatience;
  if (known == 0 || (known > 0) == pair_is_clear) return certain;
  const int doubting = known > 0 ? known - 1 : known + 1;
  return doubting == 0 ? certain : doubting;
}

#undef DUO_INLINE
#ifdef __cplusplus
}  // namespace duo
#endif
#endif
