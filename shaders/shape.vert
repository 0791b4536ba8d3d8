// All shapes use one formula: the corner is scaled to the extent and offset along the normal by the rounding radius, then
// rotated and translated.
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 place;    // w: round
layout(location = 3) in vec4 turn;     // x y z w
layout(location = 4) in vec4 extent;   // w: specular
layout(location = 5) in vec4 diffuse;  // w: alpha
layout(location = 6) in vec4 ambient;  // w: power
#ifdef COLORED
layout(location = 7) in vec2 texcoord;
layout(location = 8) in vec4 own_color;  // sRGB-encoded, as is own_emission
layout(location = 9) in vec4 own_emission;
#endif

out vec3 at;
out vec3 facing;
flat out vec4 v_diffuse;
flat out vec4 v_ambient;
flat out float v_specular;
#ifdef COLORED
out vec2 v_texcoord;
out vec3 v_color;
out vec3 v_emission;

vec3 linear_light(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}
#endif
#ifdef GROUND
out float depth;
#endif

vec3 turned(vec3 v) { return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }

void main() {
  at = place.xyz + turned(corner * extent.xyz + normal * place.w);
  // shapes without rounding are scaled non-uniformly: their normals by the inverse
  facing = turned(place.w > 0.0 ? normal : normalize(normal / extent.xyz));
  v_diffuse = diffuse;
  v_ambient = ambient;
  v_specular = extent.w;
#ifdef COLORED
  v_texcoord = texcoord;
  v_color = linear_light(own_color.rgb);
  v_emission = linear_light(own_emission.rgb);
#endif
  gl_Position = view_proj * vec4(at, 1.0);
#if CLIP_DISTANCE
  // clips in the mirror pass only; some drivers use it even if GL_CLIP_DISTANCE0 is disabled
  gl_ClipDistance[0] = eye.w > 0.5 ? at.z - floor_height : 1.0;
#endif
#ifdef GROUND
  depth = gl_Position.z;  // the projection is orthographic: w is 1
  gl_Position.z = 0.0;
#endif
}
