// An infinite plane, drawn as a square around the point below the eye that extends to where the fog is opaque.
uniform vec4 origin;  // w: half the square's width
uniform vec4 along;   // tangent; w: 1 for the scene's floor, which has contact shadows and reflections
uniform vec4 across;
uniform vec4 tint;
out vec3 at;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  at = origin.xyz + origin.w * (corner.x * along.xyz + corner.y * across.xyz);
  gl_Position = view_proj * vec4(at, 1.0);
}
