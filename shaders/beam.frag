// Beams of light, which are added to the image. A ray through the middle of a cone passes more lit air than one near
// its outline, where the surface is seen edge-on.
in vec3 v_position;
in vec3 v_normal;
in vec3 v_light;
out vec4 color;

void main() {
  float facing = abs(dot(normalize(v_normal), normalize(eye.xyz - v_position)));
  color = vec4(v_light * facing * facing, 0.0);
}
