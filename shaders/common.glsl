// In front of every file: what one pass is drawn with, and what surfaces share. In front of this one are the version of
// GLSL, SHADOW_TAPS (0: no shadow), CONTACT_TAPS (0: no darkening under things), DITHER (0, 1), and CLIP_DISTANCE (0: this
// kind of OpenGL has no gl_ClipDistance).
layout(std140) uniform Frame {
  mat4 view_proj;      // world to clip space; in the mirror's pass the world is turned over
  mat4 clip_to_world;
  mat4 lamp_map;       // world to the lamp's depth map
  mat4 ground_map;     // world to the map of what stands just above the floor
  vec4 eye;            // w 1: the mirror's pass
  vec4 lamp_at;        // w 1: where the lamp is; 0: the direction to it
  vec4 lamp_aim;       // where it shines; w: the cosine at which its cone ends
  vec4 lamp_color;     // w: the cosine up to which it is as bright as in the middle
  vec4 sky;            // light from above,
  vec4 ground;         // from below
  vec4 rim;
  vec4 horizon;        // the background, as it is shown
  vec4 zenith;
  vec4 floor_color;    // w: how much it mirrors
  vec4 grid;           // w: how plain
  vec4 tone;           // exposure, fog per metre, height of the floor, depth of shadows
  vec4 soft;           // radius of a shadow's edge in the lamp's map, in metres, and of the darkening under things in its map
};

// of one pixel, evenly from 0 to 1
float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// the background in a direction
vec3 background(vec3 along) { return mix(horizon.rgb, zenith.rgb, sqrt(clamp(along.z, 0.0, 1.0))); }

// ACES' curve: bright light turns white softly
vec3 filmic(vec3 light) {
  vec3 x = light * tone.x;
  return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

float fog(float far) {
  float x = far * tone.y;
  return 1.0 - exp(-x * x);
}

// half a step of eight bits to either side, so that dark gradients have no bands
vec3 dithered(vec3 shown, vec2 pixel) {
#if DITHER
  return max(shown + (noise(pixel) - 0.5) / 255.0 * (2.2 * pow(shown, vec3(0.545)) + 0.02), 0.0);
#else
  return shown;
#endif
}

// a sunflower's seeds: each is the one before turned by the golden angle, the first by chance
vec2 first_seed(vec2 pixel) {
  float turn = 6.2831853 * noise(pixel);
  return vec2(cos(turn), sin(turn));
}
vec2 next_seed(vec2 seed) { return mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * seed; }
float seed_radius(int i, int count) { return sqrt((float(i) + 0.5) / float(count)); }

// the direction to the lamp, and in w how much of its light comes
vec4 lamp(vec3 at) {
  vec3 to = lamp_at.xyz - at * lamp_at.w;
  vec3 along = normalize(to);
  float cone = smoothstep(lamp_aim.w, lamp_color.w, dot(-along, lamp_aim.xyz));
  return vec4(along, lamp_at.w > 0.5 ? cone : 1.0);
}

uniform sampler2DShadow lamp_depth;
uniform sampler2D ground_depth;

// how much of the lamp's light is not taken away by what stands before it
float lit(vec3 at, vec3 normal, vec3 to_lamp, vec2 pixel) {
#if SHADOW_TAPS
  float slope = 1.0 - clamp(dot(normal, to_lamp), 0.0, 1.0);
  vec4 map = lamp_map * vec4(at + normal * soft.y * (0.4 + 1.4 * slope), 1.0);
  vec3 place = map.xyz / map.w;
  if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return 1.0;
#if SHADOW_TAPS == 1
  float sum = texture(lamp_depth, place);
#else
  float sum = 0.0;
  vec2 seed = first_seed(pixel);
  for (int i = 0; i < SHADOW_TAPS; i++) {
    sum += texture(lamp_depth, vec3(place.xy + soft.x * seed_radius(i, SHADOW_TAPS) * seed, place.z));
    seed = next_seed(seed);
  }
#endif
  return mix(1.0, sum / float(SHADOW_TAPS), tone.w);
#else
  return 1.0;
#endif
}
