// Gradient noise for scripts: smooth, repeatable, identical on all machines.
#pragma once

namespace limber::script {

/// Perlin's improved noise (2002) with his permutation: -1 .. 1, 0 at integers, period 256 on each axis. [any]
double gradient_noise(double x, double y, double z);

}  // namespace limber::script
