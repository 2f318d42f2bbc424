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

/// Reads chosen frames of a series on worker threads while the caller uses the ones before. At most
/// `ahead` frames are held, however many are chosen.
class ReadAhead {
public:
  /// @param series must outlive this
  /// @param ahead, threads at least 1 each
  ReadAhead(const Series& series, std::vector<std::size_t> indices, std::size_t ahead,
            std::size_t threads);
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  ~ReadAhead();

  /// Puts the next frame, in the order chosen, into `frame`, whose memory serves for one to come;
  /// false after the last. Several threads may share one object: each frame goes to one of them.
  /// @throws what reading it threw; the frames after it can still be had.
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
  std::vector<Slot> slots_; ///< frame k of the chosen ones lies in slot k modulo their number
  std::size_t started_ = 0;
  std::size_t taken_ = 0;
  std::mutex mutex_;
  std::condition_variable_any ready_, free_;
  std::vector<std::jthread> threads_; ///< last, so that they end before what they use
};

} // namespace firetwin::run
