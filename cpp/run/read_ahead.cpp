#include "run/read_ahead.hpp"

#include <algorithm>
#include <utility>

namespace firetwin::run {

ReadAhead::ReadAhead(const Series& series, std::vector<std::size_t> indices, std::size_t ahead,
                     std::size_t threads)
    : series_(series), indices_(std::move(indices)),
      slots_(std::max<std::size_t>(std::min(ahead, indices_.size()), 1)) {
  for (std::size_t i = 0; i < std::min(std::max<std::size_t>(threads, 1), slots_.size()); ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
  }
}

ReadAhead::~ReadAhead() = default;

void ReadAhead::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto may_start = [this] {
    return started_ == indices_.size() || started_ < taken_ + slots_.size();
  };
  while (free_.wait(lock, stop, may_start) && started_ < indices_.size()) {
    const std::size_t k = started_++;
    Slot read;
    read.frame.swap(slots_[k % slots_.size()].frame);
    lock.unlock();
    try {
      read.frame.resize(series_.cells());
      series_.read(indices_[k], read.frame);
    } catch (...) {
      read.error = std::current_exception();
    }
    read.ready = true;
    lock.lock();
    slots_[k % slots_.size()] = std::move(read);
    ready_.notify_all();
  }
}

bool ReadAhead::next(std::vector<float>& frame) {
  std::unique_lock lock(mutex_);
  const auto slot = [this]() -> Slot& { return slots_[taken_ % slots_.size()]; };
  // Another thread may take frames, even the last one, while this thread waits.
  ready_.wait(lock, [&] { return taken_ == indices_.size() || slot().ready; });
  if (taken_ == indices_.size()) {
    return false;
  }
  Slot& found = slot();
  found.ready = false;
  found.frame.swap(frame);
  const std::exception_ptr error = std::exchange(found.error, nullptr);
  ++taken_;
  free_.notify_all();
  if (taken_ == indices_.size()) {
    ready_.notify_all();
  }
  if (error) {
    std::rethrow_exception(error);
  }
  return true;
}

} // namespace firetwin::run
