// A pair in lanes of four, or a whole motion at once.
#include "sim/neighbor_sums.h"

#include <algorithm>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace limber {

namespace {

using Four [[gnu::vector_size(16)]] = float;

Four load_four(const float* v) {
  Four lanes;
  std::memcpy(&lanes, v, sizeof lanes);
  return lanes;
}

void store_four(float* v, Four lanes) { std::memcpy(v, &lanes, sizeof lanes); }

template <bool Motions>
void add_by_four(std::uint32_t place, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                 NeighborSum* sums) {
  const Four one{0, 0, 0, 1}, two{0, 0, 0, 2};
  const NeighborMotion& own = motions[place];
  const Four at = load_four(own.position) - one;
  const Four own_velocity = load_four(own.velocity), own_spin = load_four(own.spin);
  NeighborSum& mine = sums[place];
  Four offset = load_four(mine.offset), velocity = load_four(mine.velocity), spin = load_four(mine.spin);
  for (const std::uint32_t other : found) {
    const NeighborMotion& near = motions[other];
    NeighborSum& its = sums[other];
    const Four r = load_four(near.position) - at;
    offset += r;
    store_four(its.offset, load_four(its.offset) - (r - two));
    if constexpr (!Motions) continue;
    velocity += load_four(near.velocity);
    spin += load_four(near.spin);
    store_four(its.velocity, load_four(its.velocity) + own_velocity);
    store_four(its.spin, load_four(its.spin) + own_spin);
  }
  store_four(mine.offset, offset);
  store_four(mine.velocity, velocity);
  store_four(mine.spin, spin);
}

#if defined(__x86_64__)

// as above: what is added to the lanes of motion is taken away negated
[[gnu::target("avx512f")]] void add_by_sixteen(std::uint32_t place, std::span<const std::uint32_t> found,
                                               const NeighborMotion* motions, NeighborSum* sums) {
  constexpr __mmask16 kOffset = 0x000f;
  const __m512 one = _mm512_maskz_mov_ps(0x0008, _mm512_set1_ps(1));
  const __m512 two = _mm512_maskz_mov_ps(0x0008, _mm512_set1_ps(2));
  const __m512 own = _mm512_load_ps(&motions[place]);
  const __m512 at = _mm512_maskz_sub_ps(kOffset, own, one);
  const __m512 taken = _mm512_sub_ps(_mm512_set1_ps(-0.0f), own);
  __m512 mine = _mm512_load_ps(&sums[place]);
  for (const std::uint32_t other : found) {
    const __m512 r = _mm512_sub_ps(_mm512_load_ps(&motions[other]), at);
    mine = _mm512_add_ps(mine, r);
    const __m512 its = _mm512_load_ps(&sums[other]);
    _mm512_store_ps(&sums[other], _mm512_sub_ps(its, _mm512_mask_sub_ps(taken, kOffset, r, two)));
  }
  _mm512_store_ps(&sums[place], mine);
}

#endif

}  // namespace

AddPairs add_pairs_by(PointLanes lanes, bool motions) {
#if defined(__x86_64__)
  if (std::min(lanes, PointFinder::widest()) == PointLanes::sixteen) return add_by_sixteen;
#else
  (void)lanes;
#endif
  return motions ? add_by_four<true> : add_by_four<false>;
}

}  // namespace limber
