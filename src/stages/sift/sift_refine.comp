#version 460
#extension GL_GOOGLE_include_directive : require
#include "stages/sift/sift_params.h"
#include "stages/sift/sift_space.glsl"
#include "stages/sift/two_floats.glsl"

// An invocation a candidate: refinement by at most five Newton steps of 27 differences and about 900 operations each, most of them
// for products of twice a float's bits. A place that moved claims the pixel it moved to: the first candidate gets it.
layout(local_size_x = kSiftRefineLanes) in;
layout(std430, binding = 0) readonly buffer Windows { ivec4 windows[]; };
layout(std430, binding = 1) readonly buffer Planes { float planes[]; };
layout(std430, binding = 2) buffer Claims { uint claims[]; };
layout(std430, binding = 3) buffer Work { uint work[]; };
layout(push_constant) uniform Push { SiftPointPush p; };

const int kSteps = 5;

// First and second derivatives of the differences along x, y and level.
struct Derivatives {
  float value, dx, dy, ds, dxx, dyy, dss, dxy, dxs, dys;
};

int middle, row_step, level_step;
float v(int s, int y, int x) { return planes[middle + s * level_step + y * row_step + x]; }

Derivatives derivatives_at(int window, Position position) {
  const Plane here = plane_of(p.shape, window, position.octave, kSiftBlurred + position.level);
  middle = here.offset + position.at.y * here.stride + position.at.x;
  row_step = here.stride;
  level_step = here.stride * room_of(p.shape, position.octave).y;
  precise Derivatives d;
  d.value = v(0, 0, 0);
  d.dx = (v(0, 0, 1) - v(0, 0, -1)) * 0.5;
  d.dy = (v(0, 1, 0) - v(0, -1, 0)) * 0.5;
  d.ds = (v(1, 0, 0) - v(-1, 0, 0)) * 0.5;
  d.dxx = v(0, 0, 1) + v(0, 0, -1) - 2 * d.value;
  d.dyy = v(0, 1, 0) + v(0, -1, 0) - 2 * d.value;
  d.dss = v(1, 0, 0) + v(-1, 0, 0) - 2 * d.value;
  d.dxy = (v(0, 1, 1) - v(0, 1, -1) - v(0, -1, 1) + v(0, -1, -1)) * 0.25;
  d.dxs = (v(1, 0, 1) - v(1, 0, -1) - v(-1, 0, 1) + v(-1, 0, -1)) * 0.25;
  d.dys = (v(1, 1, 0) - v(1, -1, 0) - v(-1, 1, 0) + v(-1, -1, 0)) * 0.25;
  return d;
}

vec2 minor(float a, float b, float c, float d) { return subtract(product_of(a, b), product_of(c, d)); }

vec2 scaled_sum(vec2 a, float x, vec2 b, float y, vec2 c, float z) {
  return add(add(multiply(a, vec2(x, 0)), multiply(b, vec2(y, 0))), multiply(c, vec2(z, 0)));
}

// Offset to the extremum of the quadratic, by Cramer's rule; false when there is none.
bool offset_of(Derivatives g, out vec3 offset) {
  const vec2 a = minor(g.dyy, g.dss, g.dys, g.dys), b = minor(g.dxs, g.dys, g.dxy, g.dss), c = minor(g.dxy, g.dys, g.dxs, g.dyy);
  const vec2 determinant = scaled_sum(a, g.dxx, b, g.dxy, c, g.dxs);
  offset = vec3(0);
  if (abs(determinant.x) < 1e-9) return false;
  const vec2 d = minor(g.dxx, g.dss, g.dxs, g.dxs), e = minor(g.dxs, g.dxy, g.dxx, g.dys), f = minor(g.dxx, g.dyy, g.dxy, g.dxy);
  offset.x = -divide(scaled_sum(a, g.dx, b, g.dy, c, g.ds), determinant).x;
  offset.y = -divide(scaled_sum(b, g.dx, d, g.dy, e, g.ds), determinant).x;
  offset.z = -divide(scaled_sum(c, g.dx, e, g.dy, f, g.ds), determinant).x;
  return true;
}

bool on_edge(Derivatives d) {
  precise const float trace = d.dxx + d.dyy;
  precise const float determinant = d.dxx * d.dyy - d.dxy * d.dxy;
  precise const float left = trace * trace * p.edge, right = (p.edge + 1) * (p.edge + 1) * determinant;
  return determinant <= 0 || left >= right;
}

// Halves away from zero.
ivec3 rounded(vec3 offset) {
  const vec3 size = abs(offset), whole = floor(size);
  return ivec3(sign(offset) * (whole + vec3(greaterThanEqual(size - whole, vec3(0.5)))));
}

// The sigma that a level stands for: 1.6 * 2^(level / 3).
float scale_of(float level) {
  return multiply(vec2(1.60000002, -2.38418583e-08), exponential(multiply(vec2(0.231049061, -6.34884811e-10), vec2(level, 0)))).x;
}

// Moves `position` to the extremum's pixel; x, y, scale and response of the place, which is none when it runs away, is weak or
// lies on an edge.
bool refine(int window, ivec2 size, inout Position position, out vec4 place) {
  place = vec4(0);
  for (int step = 0; step < kSteps; ++step) {
    const Derivatives d = derivatives_at(window, position);
    vec3 offset;
    if (!offset_of(d, offset)) return false;
    if (all(lessThan(abs(offset), vec3(0.5)))) {
      precise const float value = d.value + 0.5 * (d.dx * offset.x + d.dy * offset.y + d.ds * offset.z);
      const float contrast = quotient(abs(value), 255);
      if (contrast * kSiftLevels < p.contrast || on_edge(d)) return false;
      precise const vec3 at = vec3(position.at, position.level) + offset;
      place = vec4(at.xy, scale_of(at.z), contrast);
      return true;
    }
    if (any(greaterThan(abs(offset), vec3(size.x + size.y)))) return false;
    const ivec3 to = ivec3(position.at, position.level) + rounded(offset);
    position.at = to.xy;
    position.level = to.z;
    if (to.z < 1 || to.z > kSiftLevels || any(lessThan(to.xy, ivec2(kSiftBorder))) ||
        any(greaterThanEqual(to.xy, size - kSiftBorder)))
      return false;
  }
  return false;
}

bool in_window(Part part, int octave, vec2 at) {
  precise const vec2 place = vec2(part.corner) + at * float(1 << octave);
  return all(greaterThanEqual(place, vec2(part.window.xy))) && all(lessThan(place, vec2(part.window.zw)));
}

void main() {
  const int window = int(gl_WorkGroupID.y), i = int(gl_GlobalInvocationID.x);
  const SiftWork lists = sift_work(p.shape);
  const int first = window * lists.words, to = first + lists.places + i * kSiftPlaceWords;
  if (i >= int(work[first])) return;
  const Part part = part_of(p.shape, windows[window]);
  const int found_at = int(work[first + lists.candidates + i]);
  Position position = position_of(p.shape, found_at);
  vec4 place;
  const bool good = refine(window, size_of(part, position.octave), position, place) && in_window(part, position.octave, place.xy);
  const int at = good ? index_of(p.shape, position) : found_at;
  if (at != found_at) atomicMin(claims[window * positions_in(p.shape) + at], uint(i) + 1);
  for (int k = 0; k < 4; ++k) work[to + k] = floatBitsToUint(place[k]);
  work[to + 4] = position.octave;
  work[to + 5] = position.level;
  work[to + 6] = good ? at != found_at ? kSiftMoved : kSiftStays : kSiftNoPlace;
  work[to + 7] = at;
}
