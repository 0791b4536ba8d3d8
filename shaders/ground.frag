// Depth of the ground map, clamped to the map's range, for OpenGL versions without GL_DEPTH_CLAMP.
in float depth;

void main() { gl_FragDepth = clamp(0.5 + 0.5 * depth, 0.0, 1.0); }
