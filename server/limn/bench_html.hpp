#pragma once
#include <string>
#include <vector>

namespace limn::bench {

/// Text as HTML.
std::string escaped(const std::string& text);
/// "–" where there is no finite number.
std::string number(double value, const char* format = "%.3g");
/// Red where `bad`. `text` is HTML.
std::string marked(const std::string& text, bool bad);
/// A row of a table; cells are HTML.
std::string row(const std::vector<std::string>& cells, const char* tag = "td");
/// Begins a table.
std::string header(const std::vector<std::string>& cells);

}  // namespace limn::bench
