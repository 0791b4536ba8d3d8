// The same comparisons in lanes of four, eight and sixteen; by itself where the processor is not known.
#include "sim/point_finder.h"

#include <algorithm>
#include <bit>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace limber {

namespace {

using Word = std::uint64_t;
constexpr std::size_t kBlock = 64;  // points whose hits fit a word
static_assert(kBlock <= kPointRoom);

std::uint32_t take_hits(Word hits, const std::uint32_t* places, std::uint32_t* out) {
  std::uint32_t found = 0;
  for (; hits != 0; hits &= hits - 1) out[found++] = places[std::countr_zero(hits)];
  return found;
}

#if defined(__x86_64__)

// each has its own loop: only functions for the same processor are put into one another

template <bool Least, bool Bodies>
std::uint32_t find_by_four(const PointArrays& points, const PointQuery& q, float least, float most,
                           std::uint32_t* out) {
  const __m128 x = _mm_set1_ps(q.x), y = _mm_set1_ps(q.y), z = _mm_set1_ps(q.z);
  const __m128 low = _mm_set1_ps(least * least), high = _mm_set1_ps(most * most);
  const __m128i body = _mm_set1_epi32(q.body);
  const auto four = [&](std::size_t i) {
    const __m128 dx = _mm_sub_ps(x, _mm_loadu_ps(points.x + i));
    const __m128 dy = _mm_sub_ps(y, _mm_loadu_ps(points.y + i));
    const __m128 dz = _mm_sub_ps(z, _mm_loadu_ps(points.z + i));
    const __m128 d = _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    __m128 within = _mm_cmple_ps(d, high);
    if constexpr (Least) within = _mm_and_ps(within, _mm_cmpge_ps(d, low));
    if constexpr (!Bodies) return _mm_castps_si128(within);
    const __m128i same = _mm_cmpeq_epi32(body, _mm_loadu_si128(reinterpret_cast<const __m128i*>(points.body + i)));
    return _mm_andnot_si128(same, _mm_castps_si128(within));
  };
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < points.count; i += kBlock) {
    Word hits = 0;
    for (std::size_t k = 0; k < kBlock && i + k < points.count; k += 16) {
      const __m128i a = _mm_packs_epi32(four(i + k), four(i + k + 4));
      const __m128i b = _mm_packs_epi32(four(i + k + 8), four(i + k + 12));
      hits |= Word{static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(a, b)))} << k;
    }
    found += take_hits(hits, points.places + i, out + found);
  }
  return found;
}

template <bool Least, bool Bodies>
[[gnu::target("avx2")]] std::uint32_t find_by_eight(const PointArrays& points, const PointQuery& q, float least,
                                                    float most, std::uint32_t* out) {
  const __m256 x = _mm256_set1_ps(q.x), y = _mm256_set1_ps(q.y), z = _mm256_set1_ps(q.z);
  const __m256 low = _mm256_set1_ps(least * least), high = _mm256_set1_ps(most * most);
  const __m256i body = _mm256_set1_epi32(q.body);
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < points.count; i += kBlock) {
    Word hits = 0;
    for (std::size_t k = 0; k < kBlock && i + k < points.count; k += 8) {
      const std::size_t at = i + k;
      const __m256 dx = _mm256_sub_ps(x, _mm256_loadu_ps(points.x + at));
      const __m256 dy = _mm256_sub_ps(y, _mm256_loadu_ps(points.y + at));
      const __m256 dz = _mm256_sub_ps(z, _mm256_loadu_ps(points.z + at));
      const __m256 d =
          _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
      __m256 within = _mm256_cmp_ps(d, high, _CMP_LE_OQ);
      if constexpr (Least) within = _mm256_and_ps(within, _mm256_cmp_ps(d, low, _CMP_GE_OQ));
      if constexpr (Bodies) {
        const __m256i its = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(points.body + at));
        within = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(body, its)), within);
      }
      hits |= Word{static_cast<unsigned>(_mm256_movemask_ps(within))} << k;
    }
    found += take_hits(hits, points.places + i, out + found);
  }
  return found;
}

template <bool Least, bool Bodies>
[[gnu::target("avx512f")]] std::uint32_t find_by_sixteen(const PointArrays& points, const PointQuery& q, float least,
                                                         float most, std::uint32_t* out) {
  const __m512 x = _mm512_set1_ps(q.x), y = _mm512_set1_ps(q.y), z = _mm512_set1_ps(q.z);
  const __m512 low = _mm512_set1_ps(least * least), high = _mm512_set1_ps(most * most);
  const __m512i body = _mm512_set1_epi32(q.body);
  std::uint32_t* end = out;
  for (std::size_t i = 0; i < points.count; i += 16) {
    const __m512 dx = _mm512_sub_ps(x, _mm512_loadu_ps(points.x + i));
    const __m512 dy = _mm512_sub_ps(y, _mm512_loadu_ps(points.y + i));
    const __m512 dz = _mm512_sub_ps(z, _mm512_loadu_ps(points.z + i));
    const __m512 d = _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy)), _mm512_mul_ps(dz, dz));
    __mmask16 hits = _mm512_cmp_ps_mask(d, high, _CMP_LE_OQ);
    if constexpr (Least) hits = _mm512_mask_cmp_ps_mask(hits, d, low, _CMP_GE_OQ);
    if constexpr (Bodies) hits = _mm512_mask_cmpneq_epi32_mask(hits, body, _mm512_loadu_si512(points.body + i));
    // written whole: what is too much is written again by what comes next
    _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(hits, _mm512_loadu_si512(points.places + i)));
    end += std::popcount(static_cast<unsigned>(hits));
  }
  return static_cast<std::uint32_t>(end - out);
}

#else

template <bool Least, bool Bodies>
std::uint32_t find_by_four(const PointArrays& points, const PointQuery& q, float least, float most,
                           std::uint32_t* out) {
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < points.count; i += kBlock) {
    Word hits = 0;
    for (std::size_t k = 0; k < kBlock && i + k < points.count; k++) {
      const float dx = q.x - points.x[i + k], dy = q.y - points.y[i + k], dz = q.z - points.z[i + k];
      const float d = (dx * dx + dy * dy) + dz * dz;
      const bool near = (!Least || d >= least * least) && d <= most * most;
      if (near && (!Bodies || points.body[i + k] != q.body)) hits |= Word{1} << k;
    }
    found += take_hits(hits, points.places + i, out + found);
  }
  return found;
}

#endif

}  // namespace

PointLanes PointFinder::widest() {
#if defined(__x86_64__)
  static const PointLanes found = __builtin_cpu_supports("avx512f") ? PointLanes::sixteen
                                  : __builtin_cpu_supports("avx2")  ? PointLanes::eight
                                                                    : PointLanes::four;
  return found;
#else
  return PointLanes::four;
#endif
}

PointFinder::PointFinder(PointLanes lanes)
    : all_(find_by_four<false, false>),
      least_(find_by_four<true, false>),
      bodies_(find_by_four<false, true>),
      least_and_bodies_(find_by_four<true, true>) {
#if defined(__x86_64__)
  lanes = std::min(lanes, widest());
  if (lanes == PointLanes::eight) {
    all_ = find_by_eight<false, false>;
    least_ = find_by_eight<true, false>;
    bodies_ = find_by_eight<false, true>;
    least_and_bodies_ = find_by_eight<true, true>;
  }
  if (lanes == PointLanes::sixteen) {
    all_ = find_by_sixteen<false, false>;
    least_ = find_by_sixteen<true, false>;
    bodies_ = find_by_sixteen<false, true>;
    least_and_bodies_ = find_by_sixteen<true, true>;
  }
#else
  (void)lanes;
#endif
}

}  // namespace limber
