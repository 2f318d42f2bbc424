#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace firetwin {

/// Uninitialized array of a fixed size. The owner writes every element, usually in parallel.
template <class T> class Buffer {
public:
  Buffer() = default;
  explicit Buffer(std::size_t size)
      : values_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}

  std::size_t size() const { return size_; }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  operator std::span<T>() { return {values_.get(), size_}; }
  operator std::span<const T>() const { return {values_.get(), size_}; }

private:
  std::unique_ptr<T[]> values_;
  std::size_t size_ = 0;
};

} // namespace firetwin
