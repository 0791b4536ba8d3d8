// Converts linear light to sRGB bytes, for OpenGL versions that can't switch off the conversion of sRGB framebuffers.
uniform sampler2D picture;
out vec4 color;

void main() {
  vec3 light = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb;
  vec3 curve = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  color = vec4(mix(curve, 12.92 * light, lessThanEqual(light, vec3(0.0031308))), 1.0);
}
