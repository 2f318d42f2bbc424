#include "run/npy_header.hpp"

#include "base/error.hpp"

#include <cctype>
#include <charconv>
#include <cstdint>

namespace firetwin::run {
namespace {

class HeaderParser {
public:
  HeaderParser(std::string_view text, std::size_t offset, const std::string& path)
      : text_(text), offset_(offset), path_(path) {}

  NpyHeader parse() {
    expect('{');
    while (!accept('}')) {
      entry();
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    skip_space();
    if (at_ != text_.size() || !descr_ || !order_ || !shape_) {
      fail();
    }
    return std::move(header_);
  }

private:
  void entry() {
    const std::string key = quoted();
    expect(':');
    if (key == "descr" && !descr_) {
      descr_ = true;
      header_.descr = description();
    } else if (key == "fortran_order" && !order_) {
      order_ = true;
      header_.fortran_order = boolean();
    } else if (key == "shape" && !shape_) {
      shape_ = true;
      tuple();
    } else {
      fail();
    }
  }

  std::string description() {
    skip_space();
    if (at_ < text_.size() && text_[at_] == '[') {
      throw InputError(path_, 1, column(), "holds records; save one plain array per file");
    }
    return quoted();
  }

  std::string quoted() {
    skip_space();
    if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) {
      fail();
    }
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string_view::npos) {
      fail();
    }
    std::string value(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return value;
  }

  bool boolean() {
    skip_space();
    for (const std::string_view word : {std::string_view("True"), std::string_view("False")}) {
      if (text_.substr(at_, word.size()) == word) {
        at_ += word.size();
        return word == "True";
      }
    }
    fail();
  }

  void tuple() {
    expect('(');
    while (!accept(')')) {
      header_.shape.push_back(integer());
      if (!accept(',')) {
        expect(')');
        break;
      }
    }
  }

  std::size_t integer() {
    skip_space();
    std::size_t value = 0;
    const char* first = text_.data() + at_;
    const auto [end, code] = std::from_chars(first, text_.data() + text_.size(), value);
    if (code != std::errc()) {
      fail();
    }
    at_ += static_cast<std::size_t>(end - first);
    return value;
  }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) {
      ++at_;
    }
  }

  bool accept(char c) {
    skip_space();
    if (at_ < text_.size() && text_[at_] == c) {
      ++at_;
      return true;
    }
    return false;
  }

  void expect(char c) {
    if (!accept(c)) {
      fail();
    }
  }

  std::int64_t column() const { return static_cast<std::int64_t>(offset_ + at_ + 1); }

  [[noreturn]] void fail() const {
    throw InputError(path_, 1, column(),
                     "the .npy header is damaged; save the array again with numpy.save");
  }

  std::string_view text_;
  std::size_t offset_;
  const std::string& path_;
  std::size_t at_ = 0;
  bool descr_ = false, order_ = false, shape_ = false;
  NpyHeader header_;
};

} // namespace

NpyHeader parse_npy_header(std::string_view text, std::size_t offset, const std::string& path) {
  return HeaderParser(text, offset, path).parse();
}

} // namespace firetwin::run
