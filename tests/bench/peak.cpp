// What one core can do at most, measured in the same run: fused multiply-adds in registers, and reading from L2.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <vector>

namespace kerf::bench {
namespace {

#if defined(__AVX512F__)
constexpr int width = 8;
#elif defined(__AVX__)
constexpr int width = 4;
#else
constexpr int width = 2;
#endif
using Vector = double __attribute__((vector_size(8 * width)));
constexpr int chains = 12;  // latency times ports, and still in registers

/// Independent chains x <- a x + b; two operations per lane and step.
void fma_peak(benchmark::State& bench) {
  Vector x[chains] = {}, a = Vector{} + 0.999, b = Vector{} + 0.001;
  benchmark::DoNotOptimize(a);
  benchmark::DoNotOptimize(b);
  constexpr int rounds = 10000;
  for (auto _ : bench) {
    for (int i = 0; i < rounds; ++i)
#pragma GCC unroll 12
      for (int k = 0; k < chains; ++k) x[k] = a * x[k] + b;
    benchmark::DoNotOptimize(x);
  }
  bench.SetItemsProcessed(bench.iterations() * rounds * chains * width * 2);
}

/// Bytes per second read from a buffer of half the L2 cache.
void l2_read(benchmark::State& bench) {
  const long cache = ::sysconf(_SC_LEVEL2_CACHE_SIZE);
  const auto vectors = static_cast<std::size_t>(cache > 0 ? cache : 1 << 20) / 2 / sizeof(Vector) / 8 * 8;
  const std::vector<Vector> buffer(vectors, Vector{} + 1.0);
  Vector sum[8] = {};
  for (auto _ : bench) {
    for (std::size_t i = 0; i < vectors; i += 8)
      for (std::size_t k = 0; k < 8; ++k) sum[k] += buffer[i + k];
    benchmark::DoNotOptimize(sum);
  }
  bench.SetBytesProcessed(bench.iterations() * static_cast<std::int64_t>(vectors * sizeof(Vector)));
}

BENCHMARK(fma_peak);
BENCHMARK(l2_read);

}  // namespace
}  // namespace kerf::bench
