// Perlin's improved noise.
#include "script/api/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limber::script {

namespace {

constexpr std::array<std::uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

std::size_t permuted(std::size_t i) { return kPermutation[i & 255u]; }

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double mix(double t, double a, double b) { return a + t * (b - a); }

// dot product of the offset with one of twelve directions to the edges of a cube
double slope(std::size_t hash, double x, double y, double z) {
  const std::size_t h = hash & 15u;
  const double u = h < 8 ? x : y;
  const double v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
  return ((h & 1u) == 0 ? u : -u) + ((h & 2u) == 0 ? v : -v);
}

// index of the lattice cell of a coordinate, modulo 256
std::size_t cell(double floor) {
  return static_cast<std::size_t>(static_cast<std::uint64_t>(floor - 256 * std::floor(floor / 256)));
}

}  // namespace

double gradient_noise(double x, double y, double z) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return 0;
  const std::size_t cx = cell(std::floor(x));
  const std::size_t cy = cell(std::floor(y));
  const std::size_t cz = cell(std::floor(z));
  x -= std::floor(x);
  y -= std::floor(y);
  z -= std::floor(z);
  const double u = fade(x);
  const double v = fade(y);
  const double w = fade(z);
  const std::size_t a = permuted(cx) + cy;
  const std::size_t b = permuted(cx + 1) + cy;
  const std::size_t aa = permuted(a) + cz;
  const std::size_t ab = permuted(a + 1) + cz;
  const std::size_t ba = permuted(b) + cz;
  const std::size_t bb = permuted(b + 1) + cz;
  const auto layer = [&](std::size_t up, double dz) {
    return mix(v, mix(u, slope(permuted(aa + up), x, y, dz), slope(permuted(ba + up), x - 1, y, dz)),
               mix(u, slope(permuted(ab + up), x, y - 1, dz), slope(permuted(bb + up), x - 1, y - 1, dz)));
  };
  return std::clamp(mix(w, layer(0, z), layer(1, z - 1)), -1.0, 1.0);
}

}  // namespace limber::script
