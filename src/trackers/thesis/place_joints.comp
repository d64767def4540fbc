#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "trackers/thesis/place_joints_params.h"

// A workgroup a joint. Of V votes: reads 8 bytes of each stored point, 16 more where it is matched; V^2 comparisons for each of x
// and y, from shared memory: the median is the vote with V / 2 before it.
const int kLanes = 128;
layout(local_size_x = kLanes) in;

// duo::AreaSums, of which only the first three count here.
struct AreaSums {
  int64_t count, x, y, others[7];
  ivec4 corners;
};
layout(std430, binding = 0) readonly buffer Expected { ivec2 expected_q4[]; };
layout(std430, binding = 1) readonly buffer Colors { AreaSums colors[]; };
layout(std430, binding = 2) readonly buffer Seen { uint seen[]; };
layout(std430, binding = 3) readonly buffer Matches { ivec2 matches[]; };   // duo::PointMatch, a row of the stored capacity each
layout(std430, binding = 4) readonly buffer Ways { ivec2 to_joint_q4[]; };  // likewise
layout(std430, binding = 5) readonly buffer Disparity { uint16_t d_q4[]; };
layout(std430, binding = 6) writeonly buffer Joints { uvec4 joints[]; };  // duo::ObservedJoint: x, y, seen by, disparity
layout(push_constant) uniform Push { PlaceJointsPush p; };

const uint kSeenByColor = 1, kSeenByPoints = 2, kNone = 0xFFFF;

shared ivec2 votes_q4[kPlaceJointsVotes];
shared int vote_count, median_x_q4, median_y_q4;

int mean_q4(int64_t sum, int64_t count) { return int((32 * sum + count) / (2 * count)); }

int rounded_q4(uint word) {
  precise const float at = 16.0 * uintBitsToFloat(word) + 0.5;
  return int(floor(at));
}

void collect_votes(int lane, int joint) {
  for (int i = lane; i < p.stored.capacity; i += kLanes) {
    const int match = matches[joint * p.stored.capacity + i].x;
    if (match < 0) continue;
    const int at = sift_point(p.seen, joint, match);
    const ivec2 point_q4 = ivec2(rounded_q4(seen[at]), rounded_q4(seen[at + 1]));
    votes_q4[atomicAdd(vote_count, 1)] = point_q4 + to_joint_q4[joint * p.stored.capacity + i];
  }
}

// Whichever of equal votes comes first: the value is the same.
void find_medians(int lane, int count) {
  for (int i = lane; i < count; i += kLanes) {
    const ivec2 vote = votes_q4[i];
    ivec2 before = ivec2(0);
    for (int k = 0; k < count; ++k) {
      const ivec2 other = votes_q4[k];
      before.x += int(other.x < vote.x || (other.x == vote.x && k < i));
      before.y += int(other.y < vote.y || (other.y == vote.y && k < i));
    }
    if (before.x == count / 2) median_x_q4 = vote.x;
    if (before.y == count / 2) median_y_q4 = vote.y;
  }
}

void main() {
  const int lane = int(gl_LocalInvocationIndex), joint = int(gl_WorkGroupID.x);
  if (lane == 0) vote_count = 0;
  barrier();
  collect_votes(lane, joint);
  barrier();
  const int count = vote_count;
  find_medians(lane, count);
  barrier();
  if (lane != 0) return;
  ivec2 at = expected_q4[joint];
  uint seen_by = 0;
  const int64_t pixels = colors[joint].count;
  if (pixels >= p.least_blob_pixels) {
    seen_by |= kSeenByColor;
    at = ivec2(mean_q4(colors[joint].x, pixels), mean_q4(colors[joint].y, pixels));
  }
  if (count >= p.least_votes) {
    const ivec2 second = ivec2(median_x_q4, median_y_q4);
    at = seen_by == 0 ? second : (at + second) >> 1;
    seen_by |= kSeenByPoints;
  }
  const ivec2 pixel = (at + 8) >> 4;
  uint d = kNone;
  if (pixel.x >= 0 && pixel.y >= 0 && pixel.x < p.width && pixel.y < p.height)
    d = uint(d_q4[p.d.offset + pixel.y * p.d.stride + pixel.x]);
  joints[joint] = uvec4(at, seen_by, d);
}
