#pragma once

#include <sys/mman.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace kerf::forward {

/// Where the long arrays of a step lie. Each begins at a cache line, so that no batch of eight numbers crosses one. No
/// two begin at the same place of a page: a pass reads a dozen of them side by side, which would compete for one set of
/// the cache, and a load would be taken to wait for a store to another array. From two megabytes on they ask the
/// system for huge pages.
template <class T>
struct Spread {
  using value_type = T;
  Spread() = default;
  template <class U>
  Spread(const Spread<U>&) {}
  friend bool operator==(Spread, Spread) { return true; }

  T* allocate(std::size_t count) {
    static constinit std::atomic<std::size_t> next = 0;
    constexpr std::size_t line = 64, page = 4096, huge_page = 2 << 20, places = 32, apart = 35 * line;
    const std::size_t offset = line + next++ % places * apart, bytes = count * sizeof(T);
    const std::size_t whole = bytes < huge_page ? page : huge_page;
    const std::size_t length = (offset + bytes + whole - 1) / whole * whole;
    auto* begin = static_cast<std::byte*>(std::aligned_alloc(whole, length));
    if (!begin) throw std::bad_alloc();
    if (whole == huge_page) ::madvise(begin, length, MADV_HUGEPAGE);
    std::byte* place = begin + offset;
    *reinterpret_cast<std::byte**>(place - line) = begin;
    return reinterpret_cast<T*>(place);
  }
  void deallocate(T* place, std::size_t) {
    std::free(*reinterpret_cast<std::byte**>(reinterpret_cast<std::byte*>(place) - 64));
  }
};

using Array = std::vector<double, Spread<double>>;

}  // namespace kerf::forward
