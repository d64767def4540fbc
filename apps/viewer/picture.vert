#version 450
// A rectangle with a picture on it; no vertices are read.
layout(push_constant) uniform Place {
  vec2 from, to;  // opposite corners, -1 .. 1
};
layout(location = 0) out vec2 uv;

void main() {
  uv = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
  gl_Position = vec4(mix(from, to, uv), 0, 1);
}
