// Overlay lines: colors are not tone mapped; `strength` is lower in the pass for occluded lines.
flat in vec4 v_paint;
in float side;
uniform vec4 strength;
out vec4 color;

void main() {
  float edge = clamp((1.0 - abs(side)) / max(fwidth(side), 1e-4), 0.0, 1.0);
  color = vec4(v_paint.rgb, v_paint.a * strength.x * edge);
}
