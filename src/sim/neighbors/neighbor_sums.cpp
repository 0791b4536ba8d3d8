// Sums over pairs of points: implementations with vectors of 4 and of 16 floats.
#include "sim/neighbors/neighbor_sums.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "sim/bullet/simd.h"

namespace limber::sim {

namespace {

template <bool Motions>
void add_pairs_4(std::uint32_t index, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                 NeighborSum* sums) {
  const bullet::Float4 one{0, 0, 0, 1}, two{0, 0, 0, 2};
  const NeighborMotion& own = motions[index];
  const bullet::Float4 own_position = bullet::load(own.position) - one;
  const bullet::Float4 own_velocity = bullet::load(own.velocity),
                       own_angular_velocity = bullet::load(own.angular_velocity);
  NeighborSum& own_sum = sums[index];
  bullet::Float4 offset = bullet::load(own_sum.offset), velocity = bullet::load(own_sum.velocity),
                 angular_velocity = bullet::load(own_sum.angular_velocity);
  for (const std::uint32_t other : found) {
    const NeighborMotion& neighbor = motions[other];
    NeighborSum& other_sum = sums[other];
    const bullet::Float4 r = bullet::load(neighbor.position) - own_position;
    offset += r;
    bullet::store(other_sum.offset, bullet::load(other_sum.offset) - (r - two));
    if constexpr (!Motions) continue;
    velocity += bullet::load(neighbor.velocity);
    angular_velocity += bullet::load(neighbor.angular_velocity);
    bullet::store(other_sum.velocity, bullet::load(other_sum.velocity) + own_velocity);
    bullet::store(other_sum.angular_velocity, bullet::load(other_sum.angular_velocity) + own_angular_velocity);
  }
  bullet::store(own_sum.offset, offset);
  bullet::store(own_sum.velocity, velocity);
  bullet::store(own_sum.angular_velocity, angular_velocity);
}

#if defined(__x86_64__)

// The same with the whole struct in one vector. Velocities are negated first, so that one subtraction updates both
// offsets and velocities.
[[gnu::target("avx512f")]] void add_pairs_16(std::uint32_t index, std::span<const std::uint32_t> found,
                                             const NeighborMotion* motions, NeighborSum* sums) {
  constexpr __mmask16 kOffset = 0x000f;
  const __m512 one = _mm512_maskz_mov_ps(0x0008, _mm512_set1_ps(1));
  const __m512 two = _mm512_maskz_mov_ps(0x0008, _mm512_set1_ps(2));
  const __m512 own = _mm512_load_ps(&motions[index]);
  const __m512 own_position = _mm512_maskz_sub_ps(kOffset, own, one);
  const __m512 negated = _mm512_sub_ps(_mm512_set1_ps(-0.0f), own);
  __m512 own_sum = _mm512_load_ps(&sums[index]);
  for (const std::uint32_t other : found) {
    const __m512 r = _mm512_sub_ps(_mm512_load_ps(&motions[other]), own_position);
    own_sum = _mm512_add_ps(own_sum, r);
    const __m512 other_sum = _mm512_load_ps(&sums[other]);
    _mm512_store_ps(&sums[other], _mm512_sub_ps(other_sum, _mm512_mask_sub_ps(negated, kOffset, r, two)));
  }
  _mm512_store_ps(&sums[index], own_sum);
}

#endif

}  // namespace

AddPairs select_add_pairs(VectorWidth width, bool motions) {
#if defined(__x86_64__)
  if (std::min(width, PointFinder::widest()) == VectorWidth::sixteen) return add_pairs_16;
#else
  (void)width;
#endif
  return motions ? add_pairs_4<true> : add_pairs_4<false>;
}

}  // namespace limber::sim
