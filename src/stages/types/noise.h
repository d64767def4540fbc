// Included by C++ and by GLSL: the level of a pair's noise, and what matching makes of it.
#ifndef DUO_STAGES_NOISE_H
#define DUO_STAGES_NOISE_H
#ifdef __cplusplus
namespace duo {
#define DUO_INLINE inline
#else
#define DUO_INLINE
#endif

const int kNoiseBlock = 8;     // px, both ways
const int kNoiseRowStep = 16;  // px from one row of blocks to the next
const int kNoiseBins = 512;    // of sums over a block, the last one for all above
const int kNoiseBinStep = 16;
const int kNoiseShare = 20;  // one block of so many is at or below a picture's level

// What counts of the noise of blocks in one bin, sigma in 1/16 gray levels; at the twentieth of the blocks that is asked for it
// is three quarters of the true one, by which all else here is set. White noise of sigma 1 makes a difference of 6 sqrt(2 / pi)
// on average, so that a sum over 64 pixels times 3422 / 2^16 is sigma in 1/16. Clean pictures have up to one level of it, of
// quantisation and texture, which does not count; from 2 1/4 on all of it does, up to 16, which no camera has.
DUO_INLINE int noise_of_bin_q4(int bin) {
  const int least = 16, full = 36, most = 256;
  const int sigma = ((kNoiseBinStep * bin + kNoiseBinStep / 2) * 3422 + (1 << 15)) >> 16;
  if (sigma <= least) return 0;
  if (sigma < full) return sigma * (sigma - least) / (full - least);
  return sigma < most ? sigma : most;
}

// What counts of a JPEG's coding, sigma in 1/16 gray levels (sources/picture_bytes.h): nothing of fine coding, all from 1 1/4
// levels on. Coding flattens quiet blocks, so that the noise that is measured of them says nothing of it.
DUO_INLINE int noise_of_coding_q4(int sigma) {
  const int least = 10, full = 20, most = 256;
  if (sigma <= least) return 0;
  if (sigma < full) return sigma * (sigma - least) / (full - least);
  return sigma < most ? sigma : most;
}

// Neighbours on one surface are nearly all within six sigmas. At most 96.
DUO_INLINE int bilateral_range(int noise_q4) { return (6 * noise_q4 + 8) >> 4; }

// How much darker counts as darker: one and a half sigmas.
DUO_INLINE int census_dead_zone(int noise_q4) { return (3 * noise_q4 + 16) >> 5; }

#undef DUO_INLINE
#ifdef __cplusplus
}  // namespace duo
#endif
#endif
