#include "run/text.hpp"

#include "base/error.hpp"
#include "io/file.hpp"
#include "io/name.hpp"
#include "run/decimal.hpp"
#include "run/number.hpp"

#include <cmath>
#include <cstring>

namespace firetwin::run {
namespace {

/// A text grid of 2000 x 2000 needs about 60 MB.
constexpr std::uint64_t largest_text = 1U << 30;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

template <class T> class Parser {
public:
  explicit Parser(const std::string& path) : path_(path) {}

  /// Parses complete lines; `left` bytes of text follow them.
  void take(std::span<const char> lines, std::uint64_t left) {
    position_ = lines.data();
    end_ = lines.data() + lines.size();
    left_ = left;
    constexpr const char* mark = "\xEF\xBB\xBF";
    if (line_ == 1 && lines.size() >= 3 && std::memcmp(lines.data(), mark, 3) == 0) {
      position_ += 3;
    }
    line_start_ = position_;
    for (; position_ < end_; next_line()) {
      parse_line();
    }
  }

  Grid<T> finish() {
    if (grid_.rows == 0) {
      throw InputError(path_, 0, 0, "holds no numbers; write one row of the grid per line");
    }
    return std::move(grid_);
  }

private:
  /// Leaves position_ at the end of the line.
  void parse_line() {
    const std::size_t before = grid_.values.size();
    skip_blanks();
    while (!at_line_end()) {
      parse_value();
    }
    const std::size_t found = grid_.values.size() - before;
    if (found > 0) {
      finish_row(found);
    }
  }

  void parse_value() {
    if (!parse_plain_value()) {
      parse_any_value();
    }
    skip_separator();
  }

  /// Fast path for nearly all values: a finite number without a leading plus or a D exponent.
  bool parse_plain_value() {
    T value{};
    const auto [end, code] = read_decimal(position_, end_, value);
    if (code != std::errc() || !std::isfinite(value) || !ends_value(end)) {
      return false;
    }
    grid_.values.push_back(value);
    position_ = end;
    return true;
  }

  void parse_any_value() {
    const char* first = position_;
    const Number<T> number = parse_number<T>(first, end_);
    if (number.error == NumberError::malformed) {
      fail(first, explain_word(first, end_, number.error));
    }
    position_ = number.end;
    if (!ends_value(position_)) {
      fail(first, explain_word(first, end_, NumberError::malformed));
    }
    if (number.error == NumberError::too_large) {
      fail(first, explain_word(first, end_, number.error));
    }
    grid_.values.push_back(number.value);
  }

  /// Skips spaces and at most one comma, which may end a row: many programs write one after each
  /// value.
  void skip_separator() {
    skip_blanks();
    if (position_ < end_ && *position_ == ',') {
      ++position_;
      skip_blanks();
    }
  }

  void finish_row(std::size_t found) {
    if (grid_.rows == 0) {
      grid_.columns = found;
      const auto line_bytes = static_cast<std::size_t>(position_ - line_start_) + 1;
      const auto rest = static_cast<std::size_t>(end_ - position_) + left_;
      grid_.values.reserve(found * (rest / line_bytes + 2));
    } else if (found != grid_.columns) {
      fail(line_start_, "this row has " + std::to_string(found) + " values where the first has " +
                            std::to_string(grid_.columns) + "; make all rows equally long");
    }
    ++grid_.rows;
  }

  void skip_blanks() {
    while (position_ < end_ && is_blank(*position_)) {
      ++position_;
    }
  }

  bool at_line_end() const { return is_line_end(position_); }

  bool is_line_end(const char* c) const {
    if (c == end_ || *c == '\n' || *c == '#') {
      return true;
    }
    return *c == '\r' && (c + 1 == end_ || c[1] == '\n');
  }

  bool ends_value(const char* c) const {
    return (c < end_ && (is_blank(*c) || *c == ',')) || is_line_end(c);
  }

  void next_line() {
    const void* newline = std::memchr(position_, '\n', static_cast<std::size_t>(end_ - position_));
    position_ = newline ? static_cast<const char*>(newline) + 1 : end_;
    line_start_ = position_;
    ++line_;
  }

  [[noreturn]] void fail(const char* place, const std::string& reason) const {
    throw InputError(path_, line_, place - line_start_ + 1, reason);
  }

  const char* position_ = nullptr;
  const char* end_ = nullptr;
  const char* line_start_ = nullptr;
  std::size_t left_ = 0; ///< bytes after end_
  std::int64_t line_ = 1;
  const std::string& path_;
  Grid<T> grid_;
};

} // namespace

template <class T> Grid<T> read_text(const std::filesystem::path& path, std::size_t piece) {
  const std::string name = io::utf8(path);
  Parser<T> parser(name);
  const auto take = [&parser](std::span<const char> lines, std::uint64_t left) {
    parser.take(lines, left);
  };
  io::read_lines(path, largest_text, piece, take);
  return parser.finish();
}

template Grid<float> read_text(const std::filesystem::path&, std::size_t);
template Grid<double> read_text(const std::filesystem::path&, std::size_t);

} // namespace firetwin::run
