// Beams of light: the side of a cone.
layout(location = 0) in vec4 corner;  // position; w: brightness at this distance from its origin
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 light;   // red, green, blue

out vec3 v_position;
out vec3 v_normal;
out vec3 v_light;

void main() {
  gl_Position = view_proj * vec4(corner.xyz, 1.0);
  v_position = corner.xyz;
  v_normal = normal.xyz;
  v_light = light.rgb * corner.w;
}
