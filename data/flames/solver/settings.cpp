#include "settings.hpp"

#include <functional>
#include <map>
#include <stdexcept>

namespace flame_solver {
namespace {

using Setter = std::function<void(Settings&, const std::string&)>;

Setter whole(int Settings::* member) {
  return [member](Settings& s, const std::string& text) { s.*member = std::stoi(text); };
}

Setter real(float Settings::* member) {
  return [member](Settings& s, const std::string& text) { s.*member = std::stof(text); };
}

const std::map<std::string, Setter>& setters() {
  static const std::map<std::string, Setter> all = {
      {"cells", whole(&Settings::cells)},
      {"nx", whole(&Settings::nx)},
      {"ny", whole(&Settings::ny)},
      {"nz", whole(&Settings::nz)},
      {"crown", whole(&Settings::crown)},
      {"seed", whole(&Settings::seed)},
      {"frames", whole(&Settings::frames)},
      {"spin", real(&Settings::spin)},
      {"interval", real(&Settings::interval)},
      {"wind", real(&Settings::wind)},
      {"front", real(&Settings::front)},
      {"depth", real(&Settings::depth)},
      {"inflow", real(&Settings::inflow)},
      {"uneven", real(&Settings::uneven)},
      {"gusts", real(&Settings::gusts)},
      {"eddies", real(&Settings::eddies)},
      {"confinement", real(&Settings::confinement)},
      {"longest_step", real(&Settings::longest_step)},
      {"crown_base", real(&Settings::crown_base)},
      {"crown_top", real(&Settings::crown_top)},
      {"crown_radius", real(&Settings::crown_radius)},
      {"out", [](Settings& s, const std::string& text) { s.out = text; }},
  };
  return all;
}

} // namespace

Settings read_settings(const std::vector<std::string>& arguments) {
  Settings settings;
  for (const std::string& argument : arguments) {
    const auto equals = argument.find('=');
    const auto setter = setters().find(argument.substr(0, equals));
    if (equals == std::string::npos || setter == setters().end()) {
      throw std::invalid_argument(argument + ": not a setting of the solver");
    }
    setter->second(settings, argument.substr(equals + 1));
  }
  if (settings.out.empty() || settings.nx < 8 || settings.ny < 8 || settings.nz < 8) {
    throw std::invalid_argument("out is needed, and 8 cells or more along each axis");
  }
  return settings;
}

} // namespace flame_solver
