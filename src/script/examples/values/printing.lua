-- Prints to the terminal and the console, and warns.
print("the scene has", #sim.bodies, "bodies") --> the scene has 0 bodies
warn("no body to play with") --> warning: no body to play with
