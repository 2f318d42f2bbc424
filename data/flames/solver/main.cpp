// Solves a flame and writes its frames: solver out=PATH key=value...
#include "flame.hpp"
#include "output.hpp"

#include <cstdio>
#include <exception>

namespace {

using namespace flame_solver;

/// Advances a flame to a time in equal steps no longer than allowed.
void advance_to(Flame& flame, float end) {
  while (flame.time() < end - 1.0e-5F) {
    const float left = end - flame.time();
    flame.advance(left / std::ceil(left / flame.longest_step()));
  }
}

void solve(const Settings& settings) {
  Flame flame(settings);
  Output output(settings);
  for (int n = 0; n < settings.frames; ++n) {
    advance_to(flame, settings.spin + static_cast<float>(n) * settings.interval);
    output.add(flame);
  }
  output.close();
}

} // namespace

int main(int count, char** arguments) {
  try {
    solve(read_settings({arguments + 1, arguments + count}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
