// The floor: shadow, contact shadows, a faint grid; the mirrored scene shows through by alpha.
uniform vec4 origin;
uniform vec4 along;
uniform vec4 across;
uniform vec4 tint;
in vec3 at;
out vec4 color;

// ambient occlusion of a point of the floor by objects just above it: the fraction of ambient light that reaches it
float ambient_visibility(vec3 p) {
#if CONTACT_TAPS
  vec2 place = (ground_map * vec4(p, 1.0)).xy;
  if (any(lessThan(place, vec2(0.01))) || any(greaterThan(place, vec2(0.99)))) return 1.0;
  float occlusion = 0.0;
  vec2 direction = first_direction(gl_FragCoord.xy + 17.0);
  for (int i = 0; i < CONTACT_TAPS; i++) {
    float near = 1.0 - texture(ground_depth, place + soft.z * sample_radius(i, CONTACT_TAPS) * direction).r;
    occlusion += near * near;
    direction = next_direction(direction);
  }
  return 1.0 - 0.85 * occlusion / float(CONTACT_TAPS);
#else
  return 1.0;
#endif
}

// grid lines at a distance of `apart`, 1.5 pixels wide, faded out where they would be too dense
float lines(vec2 p, float apart) {
  vec2 q = p / apart;
  vec2 width = fwidth(q);
  vec2 d = abs(fract(q - 0.5) - 0.5) / max(width, vec2(1e-6));
  vec2 on = clamp(1.2 - d, 0.0, 1.0) * clamp(1.0 - 3.0 * width, 0.0, 1.0);
  return max(on.x, on.y);
}

void main() {
  vec3 n = cross(along.xyz, across.xyz);
  vec3 to_eye = eye.xyz - at;
  float far = length(to_eye);
  to_eye /= far;
  if (dot(n, to_eye) < 0.0) n = -n;

  vec3 albedo = floor_color.rgb * tint.rgb;
  bool stage = along.w > 0.5;
  float open = stage ? ambient_visibility(at) : 1.0;
  vec4 l = light_at(at);
  float facing_light = max(dot(n, l.xyz), 0.0);
  float incoming = l.w * facing_light;
  if (incoming > 0.0) incoming *= shadow_factor(at, n, l.xyz, gl_FragCoord.xy);
  vec3 light = albedo * (sky.rgb * open + light_color.rgb * incoming * mix(1.0, open, 0.5));

  vec2 p = vec2(dot(at, along.xyz), dot(at, across.xyz));
  float line = max(0.4 * lines(p, 1.0), lines(p, 5.0));
  vec3 shown = mix(filmic(light), grid.rgb, grid.w * line * exp(-far * fog_density * 2.2));
  float haze = fog(far);
  float mirrors = stage ? floor_color.w * (0.55 + 0.45 * (1.0 - max(dot(n, to_eye), 0.0))) : 0.0;
  float alpha = tint.w * mix(1.0 - mirrors, 1.0, haze);
  color = vec4(dithered(mix(shown, background(-to_eye), haze), gl_FragCoord.xy), alpha);
}
