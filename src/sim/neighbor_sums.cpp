// A pair in lanes of four, or a whole motion at once.
#include "sim/neighbor_sums.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "sim/lanes.h"

namespace limber {

namespace {

template <bool Motions>
void add_by_four(std::uint32_t place, std::span<const std::uint32_t> found, const NeighborMotion* motions,
                 NeighborSum* sums) {
  const Lanes one{0, 0, 0, 1}, two{0, 0, 0, 2};
  const NeighborMotion& own = motions[place];
  const Lanes at = load(own.position) - one;
  const Lanes own_velocity = load(own.velocity), own_spin = load(own.spin);
  NeighborSum& mine = sums[place];
  Lanes offset = load(mine.offset), velocity = load(mine.velocity), spin = load(mine.spin);
  for (const std::uint32_t other : found) {
    const NeighborMotion& near = motions[other];
    NeighborSum& its = sums[other];
    const Lanes r = load(near.position) - at;
    offset += r;
    store(its.offset, load(its.offset) - (r - two));
    if constexpr (!Motions) continue;
    velocity += load(near.velocity);
    spin += load(near.spin);
    store(its.velocity, load(its.velocity) + own_velocity);
    store(its.spin, load(its.spin) + own_spin);
  }
  store(mine.offset, offset);
  store(mine.velocity, velocity);
  store(mine.spin, spin);
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
