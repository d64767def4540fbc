// Islands as trees: the label of a pixel is another one of its island with a smaller index, or itself at the root.

layout(std430, binding = 1) coherent buffer Labels { uint labels[]; };  // [y][x]
layout(std430, binding = 2) coherent buffer Pixels { uint pixels[]; };  // [y][x], of a root: pixels counted so far
layout(push_constant) uniform Push { SpecklePush p; };

const int kNone = 0xFFFF;

int index(ivec2 at) { return p.d_q4.offset + at.y * p.d_q4.stride + at.x; }
uint label_index(ivec2 at) { return uint(at.y * p.width + at.x); }
int value(ivec2 at) { return int(d_q4[index(at)]); }
bool joined(int a, int b) { return a != kNone && b != kNone && abs(a - b) <= p.step_q4; }

// Halves the way that it goes. Labels only ever become smaller and stay inside their island, so that it does not matter when
// another invocation's change is seen.
uint root(uint i) {
  uint above = labels[i];
  while (above != i) {
    const uint next = labels[above];
    if (next != above) atomicMin(labels[i], next);
    i = above;
    above = next;
  }
  return i;
}
