// Depth of the map of what is just above the floor, where OpenGL can't clamp it to the map's range instead of clipping.
in float depth;

void main() { gl_FragDepth = clamp(0.5 + 0.5 * depth, 0.0, 1.0); }
