// SPDX-License-Identifier: Apache-2.0
// SHA-256 with the x86 SHA extensions. Compiled with -msha -msse4.1 where the compiler supports
// them; only this file, so that no other code requires such instructions.
#include "core/base/sha256.h"

#if defined(__SHA__) && defined(__SSE4_1__)

#include <cpuid.h>
#include <immintrin.h>

#include "core/base/sha256_constants.h"

namespace boresight {
namespace {

/// Four rounds: the state's halves are (a b e f) and (c d g h), as sha256rnds2 requires.
void fourRounds(int first, __m128i words, __m128i& abef, __m128i& cdgh) {
  const __m128i sum = _mm_add_epi32(
      words, _mm_load_si128(reinterpret_cast<const __m128i*>(kSha256Constants.data() + first)));
  cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
  abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));
}

/// The schedule's next four words from the last sixteen, oldest first.
__m128i nextWords(__m128i w0, __m128i w1, __m128i w2, __m128i w3) {
  const __m128i near = _mm_add_epi32(_mm_sha256msg1_epu32(w0, w1), _mm_alignr_epi8(w3, w2, 4));
  return _mm_sha256msg2_epu32(near, w3);
}

void compress(Sha256State& state, const std::uint8_t* blocks, std::size_t count) {
  const __m128i big_endian = _mm_set_epi64x(0x0c0d0e0f08090a0b, 0x0405060700010203);
  const __m128i abcd = _mm_loadu_si128(reinterpret_cast<const __m128i*>(state.data()));
  const __m128i efgh = _mm_loadu_si128(reinterpret_cast<const __m128i*>(state.data() + 4));
  const __m128i badc = _mm_shuffle_epi32(abcd, 0xb1);
  const __m128i hgfe = _mm_shuffle_epi32(efgh, 0x1b);
  __m128i abef = _mm_alignr_epi8(badc, hgfe, 8);
  __m128i cdgh = _mm_blend_epi16(hgfe, badc, 0xf0);
  for (std::size_t n = 0; n < count; ++n) {
    const __m128i abef_before = abef;
    const __m128i cdgh_before = cdgh;
    __m128i w[4];
    for (int i = 0; i < 4; ++i) {
      const auto* bytes = reinterpret_cast<const __m128i*>(blocks + 64 * n) + i;
      w[i] = _mm_shuffle_epi8(_mm_loadu_si128(bytes), big_endian);
      fourRounds(4 * i, w[i], abef, cdgh);
    }
    for (int group = 4; group < 16; ++group) {
      const int i = group & 3;
      w[i] = nextWords(w[i], w[(i + 1) & 3], w[(i + 2) & 3], w[(i + 3) & 3]);
      fourRounds(4 * group, w[i], abef, cdgh);
    }
    abef = _mm_add_epi32(abef, abef_before);
    cdgh = _mm_add_epi32(cdgh, cdgh_before);
  }
  const __m128i feba = _mm_shuffle_epi32(abef, 0x1b);
  const __m128i dchg = _mm_shuffle_epi32(cdgh, 0xb1);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state.data()), _mm_blend_epi16(feba, dchg, 0xf0));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(state.data() + 4), _mm_alignr_epi8(dchg, feba, 8));
}

bool processorHasSha() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0 || (ecx & bit_SSE4_1) == 0) return false;
  return __get_cpuid_count(7, 0, &eax, &ebx, &ecx, &edx) != 0 && (ebx & bit_SHA) != 0;
}

}  // namespace

Sha256Kernel sha256Instructions() { return processorHasSha() ? compress : nullptr; }

}  // namespace boresight

#else

namespace boresight {

Sha256Kernel sha256Instructions() { return nullptr; }

}  // namespace boresight

#endif
