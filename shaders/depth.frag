// Depth alone: the lamp's map, and that of what stands above the floor.
void main() {}
