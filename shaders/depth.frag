// Depth-only pass, for the shadow map and the ground map.
void main() {}
