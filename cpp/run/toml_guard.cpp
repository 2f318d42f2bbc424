#include "run/toml_guard.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <string_view>

namespace firetwin::run {
namespace {

constexpr int max_dots = 7;

class Guard {
public:
  Guard(std::span<const char> text, const std::string& path)
      : text_(text.data(), text.size()), path_(path) {}

  void check() {
    if (text_.starts_with("\xEF\xBB\xBF")) {
      at_ = line_start_ = 3;
    }
    while (at_ < text_.size()) {
      step();
    }
  }

private:
  void step() {
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (c == '"' || c == '\'') {
      skip_string(c);
    } else {
      check_character(c);
      ++at_;
    }
  }

  void check_character(char c) {
    if (c == '.' && ++dots_ > max_dots) {
      fail("has a key of more than eight parts; write keys like units.elevation");
    }
    if (c == '\n') {
      new_line(at_);
    }
    if (c == '\n' || c == '=' || c == ',') {
      dots_ = 0;
    }
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool multi_line = text_.substr(at_).starts_with(three);
    for (at_ += multi_line ? 3 : 1; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n' && !multi_line) {
        return; // invalid TOML, reported by toml++
      }
      if (c == '\n') {
        new_line(at_);
      } else if (c == '\\' && quote == '"') {
        at_ += at_ + 1 < text_.size() && text_[at_ + 1] != '\n' ? 1 : 0;
      } else if (c == quote && !multi_line) {
        ++at_;
        return;
      } else if (c == quote && text_.substr(at_).starts_with(three)) {
        skip_end(quote);
        return;
      }
    }
  }

  /// Skips the three quotes that end a string, and up to two quotes before them that belong to it.
  void skip_end(char quote) {
    const std::size_t last = std::min(at_ + 5, text_.size());
    while (at_ < last && text_[at_] == quote) {
      ++at_;
    }
  }

  void new_line(std::size_t at) {
    ++line_;
    line_start_ = at + 1;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(path_, line_, static_cast<std::int64_t>(at_ - line_start_ + 1), reason);
  }

  std::string_view text_;
  const std::string& path_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  std::int64_t line_ = 1;
  int dots_ = 0;
};

} // namespace

void guard_toml(std::span<const char> text, const std::string& path) {
  Guard(text, path).check();
}

} // namespace firetwin::run
