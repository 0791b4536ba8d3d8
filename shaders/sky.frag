// The background.
in vec4 ray;
out vec4 color;

void main() {
  vec3 along = normalize(ray.xyz / ray.w - eye.xyz);
  color = vec4(dithered(background(along), gl_FragCoord.xy), 1.0);
}
