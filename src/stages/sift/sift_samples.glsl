// The square of samples around a point: their gradients and Gaussian weights. Needs two_floats.glsl, a buffer `planes`, and
// kMostSamples, the most along one side.

const float kAtan[5] = float[5](
#include "stages/sift/atan.inc"
);

shared float x_weight[kMostSamples], y_weight[kMostSamples];

// Columns [x, z) of rows [y, w) inside an octave, its outermost pixels left out.
ivec4 samples_around(vec2 at, float reach, ivec2 size) {
  precise const vec2 first = ceil(at - reach);
  precise const vec2 last = floor(at + reach);
  return ivec4(max(ivec2(first), ivec2(1)), min(ivec2(last) + 1, size - 1));
}

// exp(-(from - at)^2 / 2 sigma^2) for the columns and, times kSiftFixed, the rows.
void weigh(int lane, ivec4 samples, vec2 at, vec2 sigma) {
  const vec2 falloff = divide(vec2(-1, 0), 2 * multiply(sigma, sigma));
  const ivec2 count = samples.zw - samples.xy;
  for (int i = lane; i < count.x + count.y; i += kSiftLanes) {
    const bool row = i >= count.x;
    const int k = row ? i - count.x : i;
    const vec2 from = row ? sum_of(float(samples.y + k), -at.y) : sum_of(float(samples.x + k), -at.x);
    const float weight = exponential(multiply(falloff, multiply(from, from))).x;
    if (row)
      y_weight[k] = weight * kSiftFixed;
    else
      x_weight[k] = weight;
  }
}

// Length of the gradient in gray levels a 2 px; direction in turns, from x right towards y down.
vec2 gradient_at(Plane plane, ivec2 at) {
  const int i = plane.offset + at.y * plane.stride + at.x;
  precise const float dx = planes[i + 1] - planes[i - 1], dy = planes[i + plane.stride] - planes[i - plane.stride];
  precise const float square = dx * dx + dy * dy;
  const float ax = abs(dx), ay = abs(dy);
  const float z = quotient(min(ax, ay), max(max(ax, ay), 1e-30));
  precise const float zz = z * z;
  precise float turns = z * (kAtan[0] + zz * (kAtan[1] + zz * (kAtan[2] + zz * (kAtan[3] + zz * kAtan[4]))));
  if (ay > ax) turns = 0.25 - turns;
  if (dx < 0) turns = 0.5 - turns;
  if (dy < 0) turns = 1 - turns;
  return vec2(root_of(vec2(square, 0)).x, turns);
}

float value_at(float magnitude, int row, int column) {
  precise const float value = magnitude * y_weight[row] * x_weight[column];
  return value;
}
