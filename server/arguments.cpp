#include "server/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace limn {
namespace {

const Flag* findFlag(const CommandSpec& spec, const std::string& dashedName) {
  for (const Flag& flag : spec.flags)
    if ("--" + flag.name == dashedName) return &flag;
  return nullptr;
}

bool takesMany(const std::string& positional) { return positional.ends_with("..."); }

Result<void> checkPositionals(const CommandSpec& spec, const std::vector<std::string>& given) {
  const size_t declared = spec.positionals.size();
  if (given.size() < declared) return usageError("missing " + spec.positionals[given.size()]);
  const bool open = declared > 0 && takesMany(spec.positionals.back());
  if (given.size() > declared && !open) return usageError("unexpected argument '" + given[declared] + "'");
  return {};
}

}  // namespace

Error usageError(std::string message) { return {"usage", std::move(message), ""}; }

Result<Arguments> Arguments::parse(const CommandSpec& spec, std::span<const std::string> words) {
  Arguments arguments;
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word == "--help" || word == "-h") arguments.m_help = true;
  }
  if (arguments.m_help) return arguments;

  bool flagsEnded = false;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (flagsEnded || word.size() < 2 || word[0] != '-') {
      arguments.m_positionals.push_back(word);
      continue;
    }
    if (word == "--") {
      flagsEnded = true;
      continue;
    }
    const size_t equals = word.find('=');
    const Flag* flag = findFlag(spec, word.substr(0, equals));
    if (!flag) return usageError("unknown flag '" + word.substr(0, equals) + "'");
    std::vector<std::string>& values = arguments.m_values[flag->name];
    if (!values.empty() && !flag->repeated) return usageError("--" + flag->name + " is given twice");
    if (flag->value.empty()) {
      if (equals != word.npos) return usageError("--" + flag->name + " takes no value");
      values.emplace_back();
    } else if (equals != word.npos) {
      values.push_back(word.substr(equals + 1));
    } else {
      const bool present = i + 1 < words.size() && !words[i + 1].starts_with("--");
      if (!present) return usageError("--" + flag->name + " needs " + flag->value);
      values.push_back(words[++i]);
    }
  }
  if (Result<void> checked = arguments.checkGiven(spec); !checked) return checked.error();
  return arguments;
}

Result<void> Arguments::checkGiven(const CommandSpec& spec) const {
  std::map<std::string, std::string> chosen;
  for (const Flag& flag : spec.flags) {
    if (flag.required && !has(flag.name)) return usageError("missing --" + flag.name + " " + flag.value);
    if (flag.group.empty() || !has(flag.name)) continue;
    const auto [other, first] = chosen.emplace(flag.group, flag.name);
    if (!first) return usageError("--" + other->second + " and --" + flag.name + " exclude each other");
  }
  return checkPositionals(spec, m_positionals);
}

std::string Arguments::text(const std::string& flag, const std::string& fallback) const {
  const auto found = m_values.find(flag);
  return found == m_values.end() ? fallback : found->second.back();
}

std::vector<std::string> Arguments::all(const std::string& flag) const {
  const auto found = m_values.find(flag);
  return found == m_values.end() ? std::vector<std::string>{} : found->second;
}

std::vector<std::string> Arguments::list(const std::string& flag) const {
  std::vector<std::string> items = splitList(text(flag), ',');
  std::erase(items, "");
  return items;
}

Result<uint64_t> Arguments::integer(const std::string& flag, uint64_t fallback, uint64_t least, uint64_t most) const {
  if (!has(flag)) return fallback;
  uint64_t value = 0;
  if (!parseInteger(text(flag), value) || value < least || value > most)
    return usageError("--" + flag + " must be an integer from " + std::to_string(least) + " to " +
                      std::to_string(most) + ", not '" + text(flag) + "'");
  return value;
}

Result<double> Arguments::real(const std::string& flag, double fallback, double least, double most) const {
  if (!has(flag)) return fallback;
  double value = 0.0;
  if (parseReal(text(flag), value) && value >= least && value <= most) return value;
  char range[96];
  std::snprintf(range, sizeof range, " must be a number from %g to %g, not '", least, most);
  return usageError("--" + flag + range + text(flag) + "'");
}

std::string helpText(const CommandSpec& spec) {
  std::string text = "usage: " + spec.name;
  for (const std::string& positional : spec.positionals) text += " " + positional;
  for (const Flag& flag : spec.flags)
    if (flag.required) text += " --" + flag.name + " " + flag.value;
  text += " [flags]\n\n" + spec.summary + "\n\nflags:\n";

  std::vector<Flag> shown = spec.flags;
  shown.push_back({"help", "", "print this text"});
  size_t column = 0;
  const auto left = [](const Flag& flag) { return "  --" + flag.name + (flag.value.empty() ? "" : " " + flag.value); };
  for (const Flag& flag : shown) column = std::max(column, left(flag).size() + 2);
  for (const Flag& flag : shown) {
    std::string line = left(flag);
    line.resize(column, ' ');
    text += line + flag.help + (flag.repeated ? " (repeatable)" : "") + "\n";
  }
  return text;
}

bool parseInteger(std::string_view text, uint64_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool parseReal(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

Result<PixelSize> parsePixelSize(const std::string& text) {
  constexpr uint64_t kMost = 65'536;  // what the wire's and the film's 16-bit tile counts can carry
  uint64_t width = 0, height = 0;
  const size_t cross = text.find('x');
  const bool parsed = cross != text.npos && parseInteger(std::string_view(text).substr(0, cross), width) &&
                      parseInteger(std::string_view(text).substr(cross + 1), height);
  if (!parsed || width < 1 || height < 1 || width > kMost || height > kMost)
    return usageError("a size is WxH, each from 1 to " + std::to_string(kMost) + ", not '" + text + "'");
  return PixelSize{uint32_t(width), uint32_t(height)};
}

std::vector<std::string> splitList(std::string_view text, char separator) {
  std::vector<std::string> items;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    items.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return items;
}

int reportFailure(const std::string& program, const Error& error) {
  std::string line = program + ": " + error.text();
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::fprintf(stderr, "%s\n", line.c_str());
  if (error.code == "usage") return kExitUsage;
  return error.code == "device-lost" ? kExitDeviceReset : kExitFailed;
}

}  // namespace limn
