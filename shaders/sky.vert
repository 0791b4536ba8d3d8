// One triangle that covers the whole view, at the far plane.
out vec4 ray;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID >> 1) * 4 - 1);
  ray = clip_to_world * vec4(corner, 1.0, 1.0);
  gl_Position = vec4(corner, 1.0, 1.0);
}
