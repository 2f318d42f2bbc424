#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace firetwin {

/// Allocator of arrays that are read across their rows: requests huge pages from Linux for large
/// ones, as each row is in another small page otherwise. Large arrays begin at different cache
/// lines of their pages, because processors confuse a load with a store at the same place of
/// another page.
template <class T> struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class U> HugePages(const HugePages<U>& /*unused*/) {}

  T* allocate(std::size_t n) {
    static std::atomic<std::size_t> count{0};
    if (!is_large(n)) {
      return static_cast<T*>(::operator new(n * sizeof(T), line));
    }
    const std::size_t begin = count++ % 9 * 448, bytes = begin + n * sizeof(T);
    const std::size_t whole = (bytes + page - 1) / page * page;
    const std::size_t size = whole - bytes <= bytes / 4 ? whole : bytes; // the rest: small pages
    void* memory = ::operator new(size, std::align_val_t{page});
#if defined(__linux__)
    madvise(memory, size, MADV_HUGEPAGE); // only advice: it may fail
#endif
    return reinterpret_cast<T*>(static_cast<std::byte*>(memory) + begin);
  }

  void deallocate(T* values, std::size_t n) {
    auto* first = reinterpret_cast<std::byte*>(values);
    if (is_large(n)) {
      first -= reinterpret_cast<std::uintptr_t>(first) % page;
    }
    ::operator delete(first, is_large(n) ? std::align_val_t{page} : line);
  }

  bool operator==(const HugePages& /*unused*/) const { return true; }

private:
  static constexpr std::size_t page = std::size_t{1} << 21;
  static constexpr std::align_val_t line{64};
  static bool is_large(std::size_t n) { return n * sizeof(T) >= page / 5 * 4; }
};

template <class T> using HugeVector = std::vector<T, HugePages<T>>;

} // namespace firetwin
