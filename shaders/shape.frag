// Shapes: hemispheric ambient light, lamp with Blinn-Phong highlight, rim light, fog.
in vec3 at;
in vec3 facing;
flat in vec4 v_diffuse;
flat in vec4 v_ambient;
flat in float v_specular;
#ifdef COLORED
in vec2 v_texcoord;
in vec3 v_color;
in vec3 v_emission;
uniform sampler2D base_color;
#endif
out vec4 color;

void main() {
#ifdef MIRRORED
  if (at.z < floor_height) discard;  // replaces gl_ClipDistance
#endif
  vec3 n = normalize(facing);
  vec3 to_eye = eye.xyz - at;
  float far = length(to_eye);
  to_eye /= far;

  vec3 diffuse = v_diffuse.rgb;
  vec3 ambient = v_ambient.rgb;
#ifdef COLORED
  vec3 base = v_color * texture(base_color, v_texcoord).rgb;
  diffuse *= base;
  ambient *= base;
#endif

  // ambient light from above decreases near the floor
  float open = mix(0.55, 1.0, smoothstep(0.0, 0.9, at.z - floor_height));
  vec3 light = ambient * mix(ground.rgb, sky.rgb * open, 0.5 + 0.5 * n.z);

  vec4 l = light_at(at);
  float facing_light = dot(n, l.xyz);
  float incoming = 0.0;
  if (facing_light > 0.0 && l.w > 0.0) incoming = l.w * shadow_factor(at, n, l.xyz, gl_FragCoord.xy);
  vec3 half_way = normalize(l.xyz + to_eye);
  float shine = v_specular * (v_ambient.w + 8.0) * 0.04 * pow(max(dot(n, half_way), 0.0), v_ambient.w);
  light += light_color.rgb * incoming * max(facing_light, 0.0) * (diffuse + shine);

  // rim light has mostly the hue of the shape, so that it doesn't tint a color that was set
  float edge = 1.0 - clamp(dot(n, to_eye), 0.0, 1.0);
  float brightest = max(max(diffuse.r, diffuse.g), max(diffuse.b, 1e-3));
  vec3 rim_hue = mix(vec3(1.0), diffuse / brightest, 0.8);
  light += rim.rgb * rim_hue * pow(edge, 2.8) * (0.45 + 0.55 * n.z);

#ifdef COLORED
  light += v_emission;
#endif

  // transparent shapes are more opaque at their silhouette (Fresnel)
  float alpha = v_diffuse.w;
  if (alpha < 1.0) alpha = mix(alpha, 1.0, 0.7 * edge * edge * edge);
  // reflections fade with height above the floor
  if (eye.w > 0.5) alpha *= exp(-0.28 * (at.z - floor_height));
  color = vec4(dithered(mix(filmic(light), background(-to_eye), fog(far)), gl_FragCoord.xy), alpha);
}
