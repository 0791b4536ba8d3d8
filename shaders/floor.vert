// An endless plane: a square about the point below the eye, as wide as the fog lets one see.
uniform vec4 origin;  // w: half its width
uniform vec4 along;   // two directions in it; w of the first: 1 when things stand on it
uniform vec4 across;
uniform vec4 tint;
out vec3 at;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  at = origin.xyz + origin.w * (corner.x * along.xyz + corner.y * across.xyz);
  gl_Position = view_proj * vec4(at, 1.0);
}
