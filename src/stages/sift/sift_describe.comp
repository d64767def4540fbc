#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"
#include "stages/sift/two_floats.glsl"

layout(std430, binding = 1) readonly buffer Planes { float planes[]; };
const int kMostSamples = 80;  // along a side: 3.54 cells of 3 scales of at most 3.6 px to both sides
#include "stages/sift/sift_samples.glsl"

// A workgroup a point: 4x4 cells of 8 directions. At most 6000 samples, of which half lie in the turned square, of four floats,
// about 150 operations and eight atomics in shared memory each; 38 words are written.
layout(local_size_x = kSiftLanes) in;
layout(std430, binding = 0) readonly buffer Windows { ivec4 windows[]; };
layout(std430, binding = 2) readonly buffer Work { uint work[]; };
layout(std430, binding = 3) buffer Points { uint points[]; };
layout(push_constant) uniform Push { SiftPointPush p; };

const int kCells = 4, kDirections = 8;
const int kBins = kCells + 2;  // with one cell around, which is thrown away
shared int histogram[kBins * kBins * kDirections];
shared int64_t squares[kSiftLanes];
shared uint bytes[kSiftLanes];

// Cosine and sine of an angle in [0, 1] turns, as sift::cos_sin computes them.
void cos_sin(float turns, out vec2 cos, out vec2 sin) {
  precise const float fourth = 4 * turns;
  const int quadrant = int(fourth + 0.5);
  precise const float rest = fourth - float(quadrant);
  const vec2 x = multiply(vec2(1.57079637, -4.37113883e-08), vec2(rest, 0)), z = multiply(x, x), one = vec2(1, 0);
  vec2 s = one, c = one;
  for (int k = 4; k >= 1; --k) s = subtract(one, multiply(divide(z, vec2(2 * k * (2 * k + 1), 0)), s));
  for (int k = 5; k >= 1; --k) c = subtract(one, multiply(divide(z, vec2(2 * k * (2 * k - 1), 0)), c));
  s = multiply(x, s);
  cos = (quadrant & 1) != 0 ? s : c;
  sin = (quadrant & 1) != 0 ? c : s;
  if ((quadrant & 3) == 1 || (quadrant & 3) == 2) cos = -cos;
  if ((quadrant & 3) >= 2) sin = -sin;
}

void add_sample(vec2 gradient, float value, float column, float row, float turned) {
  precise float direction = (gradient.y - turned) * float(kDirections);
  if (direction < 0) direction += float(kDirections);
  const int c = int(column), r = int(row), d = int(direction);
  precise const float to_c = column - float(c), to_r = row - float(r), to_d = direction - float(d);
  for (int i = 0; i < 8; ++i) {
    precise const float in_row = value * ((i & 4) != 0 ? to_r : 1 - to_r);
    precise const float in_cell = in_row * ((i & 2) != 0 ? to_c : 1 - to_c);
    precise const float share = in_cell * ((i & 1) != 0 ? to_d : 1 - to_d);
    const int cell = (r + (i >> 2)) * kBins + c + (i >> 1 & 1);
    atomicAdd(histogram[cell * kDirections + (d + (i & 1)) % kDirections], int(roundEven(share)));
  }
}

// Of all invocations' bins.
int64_t sum_of_squares(int lane, int bin) {
  barrier();
  squares[lane] = int64_t(bin) * bin;
  barrier();
  int64_t sum = 0;
  for (int i = 0; i < kSiftLanes; ++i) sum += squares[i];
  return sum;
}

vec2 two_floats(int64_t value) {
  const float high = float(value);
  return sum_of_ordered(high, float(value - int64_t(high)));
}

// The fifth of a root, rounded down, which is the root of the 25th.
int clamp_of(int64_t square) {
  int64_t root = int64_t(0.2 * sqrt(float(square)));
  if (root > 0) root = (root + square / 25 / root) / 2;  // Newton's; off by at most one now
  while (25 * root * root > square) --root;
  while (25 * (root + 1) * (root + 1) <= square) ++root;
  return int(root);
}

// 128 bytes from the histogram.
void write_descriptor(int lane, int to) {
  const int cell = lane / kDirections;
  int bin = histogram[((cell / kCells + 1) * kBins + cell % kCells + 1) * kDirections + lane % kDirections];
  bin = min(bin, clamp_of(sum_of_squares(lane, bin)));
  const int64_t square = max(sum_of_squares(lane, bin), int64_t(1));
  const vec2 scale = divide(vec2(512, 0), root_of(two_floats(square)));
  const vec2 byte = add(multiply(two_floats(int64_t(bin)), scale), vec2(0.5, 0));
  const float whole = floor(byte.x);
  bytes[lane] = min(uint(byte.x == whole && byte.y < 0 ? whole - 1 : whole), 255);
  barrier();
  if (lane >= kSiftDescriptorWords) return;
  points[to + lane] = bytes[4 * lane] | bytes[4 * lane + 1] << 8 | bytes[4 * lane + 2] << 16 | bytes[4 * lane + 3] << 24;
}

// duo::SiftPoint, in pixels of the picture.
void write_point(int to, ivec2 corner, vec2 at, float scale, float turns, uint response, int octave, int level) {
  const float octave_px = float(1 << octave);
  precise const vec2 place = vec2(corner) + at * octave_px;
  precise const float angle = turns * 6.28318531;
  points[to] = floatBitsToUint(place.x);
  points[to + 1] = floatBitsToUint(place.y);
  points[to + 2] = floatBitsToUint(scale * octave_px);
  points[to + 3] = floatBitsToUint(angle);
  points[to + 4] = response;
  points[to + 5] = octave | level << 8;
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), window = int(gl_WorkGroupID.y), i = int(gl_WorkGroupID.x);
  if (i >= int(points[sift_head(window)])) return;
  const SiftWork lists = sift_work(p.shape);
  const int first = window * lists.words, source = int(work[first + lists.points + i]);
  const int from_place = first + lists.places + source / kSiftMostAngles * kSiftPlaceWords;
  const vec2 at = uintBitsToFloat(uvec2(work[from_place], work[from_place + 1]));
  const float scale = uintBitsToFloat(work[from_place + 2]);
  const int octave = int(work[from_place + 4]), level = int(work[from_place + 5]);
  const float turns = uintBitsToFloat(work[from_place + 9 + source % kSiftMostAngles]);
  const Part part = part_of(p.shape, windows[window]);

  for (int k = lane; k < kBins * kBins * kDirections; k += kSiftLanes) histogram[k] = 0;
  precise const float cell_px = 3 * scale;
  precise const float reach = (1.41421356 * float(kCells + 1) / 2) * cell_px;
  const ivec4 samples = samples_around(at, reach, size_of(part, octave));
  weigh(lane, samples, at, vec2(cell_px * (kCells / 2), 0));
  vec2 exact_cos, exact_sin;
  cos_sin(turns, exact_cos, exact_sin);
  const float cos = divide(exact_cos, vec2(cell_px, 0)).x, sin = divide(exact_sin, vec2(cell_px, 0)).x;
  barrier();
  const float shift = (kCells + 1) * 0.5;  // the centre, counted from the middle of the outermost cells
  const Plane plane = plane_of(p.shape, window, octave, level);
  const int wide = samples.z - samples.x, count = wide * (samples.w - samples.y);
  for (int k = lane; k < count; k += kSiftLanes) {
    const ivec2 from = ivec2(k % wide, k / wide);
    precise const vec2 d = vec2(samples.xy + from) - at;
    precise const float column = d.x * cos + d.y * sin + shift, row = d.y * cos - d.x * sin + shift;
    if (!(column > 0 && column < kCells + 1 && row > 0 && row < kCells + 1)) continue;
    const vec2 gradient = gradient_at(plane, samples.xy + from);
    add_sample(gradient, value_at(gradient.x, from.y, from.x), column, row, turns);
  }
  barrier();
  const SiftListShape shape = SiftListShape(p.shape.windows, p.shape.capacity);
  write_descriptor(lane, sift_descriptor(shape, window, i));
  if (lane == 0)
    write_point(sift_point(shape, window, i), part.corner, at, scale, turns, work[from_place + 3], octave, level);
}
