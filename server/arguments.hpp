#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/result.hpp"

namespace limn {

/// What a program of ours answers the shell. DESIGN.md section 8.
enum ExitCode : int { kExitOk = 0, kExitFailed = 1, kExitUsage = 64, kExitDeviceReset = 75 };

/// One `--flag`. The tables of these are all that --help and the parser know.
struct Flag {
  std::string name;              ///< "size", without the dashes
  std::string value;             ///< "WxH"; empty: a switch without a value
  std::string help = {};         ///< one line
  bool repeated = false;         ///< may be given several times
  std::string group = {};        ///< at most one flag of a group may be given; empty: none
  bool required = false;
};

/// A program or a subcommand.
struct CommandSpec {
  std::string name;              ///< "limn render"
  std::string summary;           ///< one sentence
  std::vector<std::string> positionals;  ///< "SCENE", in order; the last may end in "..." and then takes one or more
  std::vector<Flag> flags;       ///< --help is always there
};

/// A parsed command line. Usage errors carry the code "usage" and no place.
class Arguments {
 public:
  /// Takes "--name value" and "--name=value"; "--" ends the flags. With --help nothing else is checked.
  static Result<Arguments> parse(const CommandSpec& spec, std::span<const std::string> words);

  bool help() const { return m_help; }
  bool has(const std::string& flag) const { return m_values.count(flag) > 0; }
  /// The last value given, or `fallback`.
  std::string text(const std::string& flag, const std::string& fallback = "") const;
  /// Every value of a repeated flag, in order.
  std::vector<std::string> all(const std::string& flag) const;
  /// A value of the form "a,b,c"; empty items are dropped.
  std::vector<std::string> list(const std::string& flag) const;
  Result<uint64_t> integer(const std::string& flag, uint64_t fallback, uint64_t least, uint64_t most) const;
  /// Finite.
  Result<double> real(const std::string& flag, double fallback, double least, double most) const;
  const std::vector<std::string>& positionals() const { return m_positionals; }

 private:
  Result<void> checkGiven(const CommandSpec& spec) const;

  bool m_help = false;
  std::map<std::string, std::vector<std::string>> m_values;
  std::vector<std::string> m_positionals;
};

/// The complete text of --help.
std::string helpText(const CommandSpec& spec);

Error usageError(std::string message);
/// Whole-string decimal numbers: no sign on the integer, no blanks, no inf or nan.
bool parseInteger(std::string_view text, uint64_t& value);
bool parseReal(std::string_view text, double& value);
/// "WxH", both 1..65536 [pixel].
struct PixelSize { uint32_t width = 0, height = 0; };
Result<PixelSize> parsePixelSize(const std::string& text);
std::vector<std::string> splitList(std::string_view text, char separator);

/// Prints "program: text" as one line on stderr; returns 64 for "usage", 75 for "device-lost", else 1.
int reportFailure(const std::string& program, const Error& error);

}  // namespace limn
