#pragma once

#include "run/series.hpp"

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace firetwin::run {

/// Prefetches selected frames of a series on worker threads while the caller processes previous
/// ones. Holds at most `ahead` frames.
class ReadAhead {
public:
  /// @param series must outlive this object
  /// @param ahead, threads at least 1 each
  ReadAhead(const Series& series, std::vector<std::size_t> indices, std::size_t ahead,
            std::size_t threads);
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  ~ReadAhead();

  /// Moves the next selected frame into `frame` and reuses its previous memory; returns false after
  /// the last one. Thread-safe: each frame goes to one thread.
  /// @throws the error of reading this frame; later frames remain available
  bool next(std::vector<float>& frame);

private:
  struct Slot {
    bool ready = false;
    std::vector<float> frame;
    std::exception_ptr error;
  };
  void work(const std::stop_token& stop);

  const Series& series_;
  std::vector<std::size_t> indices_;
  std::vector<Slot> slots_; ///< selected frame k is in slot k modulo the number of slots
  std::size_t started_ = 0;
  std::size_t taken_ = 0;
  std::mutex mutex_;
  std::condition_variable_any ready_, free_;
  std::vector<std::jthread>
      threads_; ///< last member, so that threads end before the members they use
};

} // namespace firetwin::run
