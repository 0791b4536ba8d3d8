// PointFinder: implementations with vectors of 4, 8 and 16 floats, and a scalar one for other processors.
#include "sim/neighbors/point_finder.h"

#include <algorithm>
#include <bit>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace limber::sim {

namespace {

using Word = std::uint64_t;
constexpr std::size_t kBlock = 64;  // points per hit mask
static_assert(kBlock <= kPointPadding);

std::uint32_t write_hits(Word hits, const std::uint32_t* values, std::uint32_t* out) {
  std::uint32_t found = 0;
  for (; hits != 0; hits &= hits - 1) out[found++] = values[std::countr_zero(hits)];
  return found;
}

#if defined(__x86_64__)

// Each has its own loop, since the compiler only inlines functions with the same target attribute.

template <bool CheckMin, bool SkipBody>
std::uint32_t find_4(const PointArrays& points, const PointQuery& q, float min_distance, float max_distance,
                     std::uint32_t* out) {
  const __m128 x = _mm_set1_ps(q.x), y = _mm_set1_ps(q.y), z = _mm_set1_ps(q.z);
  const __m128 low = _mm_set1_ps(min_distance * min_distance), high = _mm_set1_ps(max_distance * max_distance);
  const __m128i body = _mm_set1_epi32(q.body);
  const auto four = [&](std::size_t i) {
    const __m128 dx = _mm_sub_ps(x, _mm_loadu_ps(points.x + i));
    const __m128 dy = _mm_sub_ps(y, _mm_loadu_ps(points.y + i));
    const __m128 dz = _mm_sub_ps(z, _mm_loadu_ps(points.z + i));
    const __m128 d = _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
    __m128 within = _mm_cmple_ps(d, high);
    if constexpr (CheckMin) within = _mm_and_ps(within, _mm_cmpge_ps(d, low));
    if constexpr (!SkipBody) return _mm_castps_si128(within);
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
    found += write_hits(hits, points.values + i, out + found);
  }
  return found;
}

template <bool CheckMin, bool SkipBody>
[[gnu::target("avx2")]] std::uint32_t find_8(const PointArrays& points, const PointQuery& q, float min_distance,
                                             float max_distance, std::uint32_t* out) {
  const __m256 x = _mm256_set1_ps(q.x), y = _mm256_set1_ps(q.y), z = _mm256_set1_ps(q.z);
  const __m256 low = _mm256_set1_ps(min_distance * min_distance), high = _mm256_set1_ps(max_distance * max_distance);
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
      if constexpr (CheckMin) within = _mm256_and_ps(within, _mm256_cmp_ps(d, low, _CMP_GE_OQ));
      if constexpr (SkipBody) {
        const __m256i other_bodies = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(points.body + at));
        within = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(body, other_bodies)), within);
      }
      hits |= Word{static_cast<unsigned>(_mm256_movemask_ps(within))} << k;
    }
    found += write_hits(hits, points.values + i, out + found);
  }
  return found;
}

template <bool CheckMin, bool SkipBody>
[[gnu::target("avx512f")]] std::uint32_t find_16(const PointArrays& points, const PointQuery& q, float min_distance,
                                                 float max_distance, std::uint32_t* out) {
  const __m512 x = _mm512_set1_ps(q.x), y = _mm512_set1_ps(q.y), z = _mm512_set1_ps(q.z);
  const __m512 low = _mm512_set1_ps(min_distance * min_distance), high = _mm512_set1_ps(max_distance * max_distance);
  const __m512i body = _mm512_set1_epi32(q.body);
  std::uint32_t* end = out;
  for (std::size_t i = 0; i < points.count; i += 16) {
    const __m512 dx = _mm512_sub_ps(x, _mm512_loadu_ps(points.x + i));
    const __m512 dy = _mm512_sub_ps(y, _mm512_loadu_ps(points.y + i));
    const __m512 dz = _mm512_sub_ps(z, _mm512_loadu_ps(points.z + i));
    const __m512 d = _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy)), _mm512_mul_ps(dz, dz));
    __mmask16 hits = _mm512_cmp_ps_mask(d, high, _CMP_LE_OQ);
    if constexpr (CheckMin) hits = _mm512_mask_cmp_ps_mask(hits, d, low, _CMP_GE_OQ);
    if constexpr (SkipBody) hits = _mm512_mask_cmpneq_epi32_mask(hits, body, _mm512_loadu_si512(points.body + i));
    // stores the full vector; the next store overwrites the surplus
    _mm512_storeu_si512(end, _mm512_maskz_compress_epi32(hits, _mm512_loadu_si512(points.values + i)));
    end += std::popcount(static_cast<unsigned>(hits));
  }
  return static_cast<std::uint32_t>(end - out);
}

#else

template <bool CheckMin, bool SkipBody>
std::uint32_t find_4(const PointArrays& points, const PointQuery& q, float min_distance, float max_distance,
                     std::uint32_t* out) {
  std::uint32_t found = 0;
  for (std::size_t i = 0; i < points.count; i += kBlock) {
    Word hits = 0;
    for (std::size_t k = 0; k < kBlock && i + k < points.count; k++) {
      const float dx = q.x - points.x[i + k], dy = q.y - points.y[i + k], dz = q.z - points.z[i + k];
      const float d = (dx * dx + dy * dy) + dz * dz;
      const bool near = (!CheckMin || d >= min_distance * min_distance) && d <= max_distance * max_distance;
      if (near && (!SkipBody || points.body[i + k] != q.body)) hits |= Word{1} << k;
    }
    found += write_hits(hits, points.values + i, out + found);
  }
  return found;
}

#endif

}  // namespace

VectorWidth PointFinder::widest() {
#if defined(__x86_64__)
  static const VectorWidth found = __builtin_cpu_supports("avx512f") ? VectorWidth::sixteen
                                   : __builtin_cpu_supports("avx2")  ? VectorWidth::eight
                                                                     : VectorWidth::four;
  return found;
#else
  return VectorWidth::four;
#endif
}

PointFinder::PointFinder(VectorWidth width)
    : all_(find_4<false, false>),
      min_(find_4<true, false>),
      skip_body_(find_4<false, true>),
      min_and_skip_body_(find_4<true, true>) {
#if defined(__x86_64__)
  width = std::min(width, widest());
  if (width == VectorWidth::eight) {
    all_ = find_8<false, false>;
    min_ = find_8<true, false>;
    skip_body_ = find_8<false, true>;
    min_and_skip_body_ = find_8<true, true>;
  }
  if (width == VectorWidth::sixteen) {
    all_ = find_16<false, false>;
    min_ = find_16<true, false>;
    skip_body_ = find_16<false, true>;
    min_and_skip_body_ = find_16<true, true>;
  }
#else
  (void)width;
#endif
}

}  // namespace limber::sim
