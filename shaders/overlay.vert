// Lines of the debug overlay: each is a quad with a constant width in pixels.
layout(location = 0) in vec4 from;   // w: width in pixels
layout(location = 1) in vec4 to;
layout(location = 2) in vec4 paint;

uniform vec4 screen;  // pixels across and down
flat out vec4 v_paint;
out float side;       // -1 .. 1 across the line

void main() {
  vec4 a = view_proj * vec4(from.xyz, 1.0);
  vec4 b = view_proj * vec4(to.xyz, 1.0);
  // clips the line in front of the eye, because points behind it can't be projected
  float near = 1e-3;
  if (a.w < near && b.w < near) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 way = (b.xy / b.w - a.xy / a.w) * screen.xy;
  way = length(way) > 1e-4 ? normalize(way) : vec2(1.0, 0.0);
  vec2 across = vec2(-way.y, way.x);
  side = float(gl_VertexID & 1) * 2.0 - 1.0;
  bool end = (gl_VertexID >> 1) == 1;
  vec4 at = end ? b : a;
  // half a pixel wider on either side for anti-aliasing, and extended beyond the ends so that corners close
  vec2 shift = (across * side + way * (end ? 1.0 : -1.0) * 0.5) * (from.w * 0.5 + 0.5);
  gl_Position = at + vec4(2.0 * shift / screen.xy * at.w, 0.0, 0.0);
  v_paint = paint;
}
