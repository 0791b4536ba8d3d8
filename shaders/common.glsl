// Prepended to every shader: the uniform block of a pass and shared functions. The program prepends the GLSL version and
// the macros SHADOW_TAPS (0: no shadow), CONTACT_TAPS (0: no contact shadows), DITHER (0 or 1), and CLIP_DISTANCE (0:
// gl_ClipDistance is not available).
layout(std140) uniform Frame {
  mat4 view_proj;      // world to clip space; in the mirror pass, the world is mirrored at the floor
  mat4 clip_to_world;
  mat4 shadow_map;     // world to texture coordinates of the shadow map
  mat4 ground_map;     // world to texture coordinates of the ground map (objects just above the floor)
  vec4 eye;            // w 1: mirror pass
  vec4 light_position;   // w 1: position of the light; w 0: direction to it
  vec4 light_direction;  // direction in which it shines; w: cosine of the cone's outer angle
  vec4 light_color;    // w: cosine of the cone's inner angle
  vec4 sky;            // ambient light from above
  vec4 ground;         // ambient light from below
  vec4 rim;            // rim light
  vec4 horizon;        // background at the horizon, not tone mapped
  vec4 zenith;         // background straight above
  vec4 floor_color;    // w: reflectivity
  vec4 grid;           // w: opacity
  float exposure;
  float fog_density;   // per meter
  float floor_height;
  float shadow_strength;
  vec4 soft;           // penumbra radius in shadow map units and in meters, contact shadow radius in ground map units
};

// interleaved gradient noise of a pixel, 0..1
float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// the background in a direction
vec3 background(vec3 along) { return mix(horizon.rgb, zenith.rgb, sqrt(clamp(along.z, 0.0, 1.0))); }

// ACES filmic tone mapping (Narkowicz's fit)
vec3 filmic(vec3 light) {
  vec3 x = light * exposure;
  return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

float fog(float far) {
  float x = far * fog_density;
  return 1.0 - exp(-x * x);
}

// adds noise of half an 8-bit step, so that dark gradients show no banding
vec3 dithered(vec3 shown, vec2 pixel) {
#if DITHER
  return max(shown + (noise(pixel) - 0.5) / 255.0 * (2.2 * pow(shown, vec3(0.545)) + 0.02), 0.0);
#else
  return shown;
#endif
}

// Vogel spiral for sampling a disk: each direction is the previous one rotated by the golden angle; the first is random
vec2 first_direction(vec2 pixel) {
  float turn = 6.2831853 * noise(pixel);
  return vec2(cos(turn), sin(turn));
}
vec2 next_direction(vec2 direction) { return mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; }
float sample_radius(int i, int count) { return sqrt((float(i) + 0.5) / float(count)); }

// direction to the light; w: attenuation by its cone
vec4 light_at(vec3 at) {
  vec3 to = light_position.xyz - at * light_position.w;
  vec3 along = normalize(to);
  float cone = smoothstep(light_direction.w, light_color.w, dot(-along, light_direction.xyz));
  return vec4(along, light_position.w > 0.5 ? cone : 1.0);
}

uniform sampler2DShadow shadow_depth;
uniform sampler2D ground_depth;

// shadow factor: the fraction of the light that reaches the point
float shadow_factor(vec3 at, vec3 normal, vec3 to_light, vec2 pixel) {
#if SHADOW_TAPS
  float slope = 1.0 - clamp(dot(normal, to_light), 0.0, 1.0);
  vec4 map = shadow_map * vec4(at + normal * soft.y * (0.4 + 1.4 * slope), 1.0);
  vec3 place = map.xyz / map.w;
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
#if SHADOW_TAPS == 1
  float sum = texture(shadow_depth, place);
#else
  float sum = 0.0;
  vec2 direction = first_direction(pixel);
  for (int i = 0; i < SHADOW_TAPS; i++) {
    sum += texture(shadow_depth, vec3(place.xy + soft.x * sample_radius(i, SHADOW_TAPS) * direction, place.z));
    direction = next_direction(direction);
  }
#endif
  return mix(1.0, sum / float(SHADOW_TAPS), shadow_strength);
#else
  return 1.0;
#endif
}
