#include "inverse/dakota.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

/// A line of either format as value and tag; aprepro's keywords become those of the standard format.
struct Entry {
  std::string value, tag;
  int line;
};

class Reader {
 public:
  Reader(std::string_view text, std::string name) : name_(std::move(name)) {
    std::istringstream lines{std::string(text)};
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      std::istringstream words(line);
      Entry entry{.value = {}, .tag = {}, .line = number};
      std::string equals;
      words >> entry.value;
      if (entry.value.empty()) continue;
      if (entry.value == "{")
        words >> entry.tag >> equals >> entry.value;
      else
        words >> entry.tag;
      if (entry.tag.empty())
        refuse(number, fmt::format("\"{}\" is neither \"VALUE NAME\" nor \"{{ NAME = VALUE }}\"", line));
      entries_.push_back(entry);
    }
  }

  /// The count that opens a section, under either of its names.
  std::size_t count(const char* standard, const char* aprepro) {
    if (next_ == entries_.size()) refuse(0, fmt::format("ends before the number of {}", standard));
    const Entry& entry = entries_[next_++];
    if (entry.tag != standard && entry.tag != aprepro)
      refuse(entry.line, fmt::format("\"{}\" stands where the number of {} belongs", entry.tag, standard));
    const double number = value(entry);
    if (number < 0 || number != std::floor(number) || number > 1e6)
      refuse(entry.line, fmt::format("\"{}\" is not a number of {}", entry.value, standard));
    return static_cast<std::size_t>(number);
  }

  const Entry& entry(const char* what) {
    if (next_ == entries_.size()) refuse(0, fmt::format("ends before all {} are named", what));
    return entries_[next_++];
  }

  double value(const Entry& entry) const {
    try {
      std::size_t used = 0;
      const double number = std::stod(entry.value, &used);
      if (used == entry.value.size() && std::isfinite(number)) return number;
    } catch (const std::logic_error&) {  // not a number at all, or out of range
    }
    refuse(entry.line, fmt::format("{} = \"{}\" is not a number", entry.tag, entry.value));
  }

  [[noreturn]] void refuse(int line, const std::string& cause) const {
    throw InputError(line > 0 ? fmt::format("{}:{}: {}", name_, line, cause) : fmt::format("{}: {}", name_, cause));
  }

 private:
  std::string name_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

}  // namespace

DakotaRequest read_dakota_request(std::string_view text, const std::string& name) {
  Reader reader(text, name);
  DakotaRequest request;
  const std::size_t variables = reader.count("variables", "DAKOTA_VARS");
  for (std::size_t i = 0; i < variables; ++i) {
    const Entry& entry = reader.entry("variables");
    request.variables.emplace_back(entry.tag, reader.value(entry));
  }
  const std::size_t functions = reader.count("functions", "DAKOTA_FNS");
  for (std::size_t i = 0; i < functions; ++i) {
    const Entry& entry = reader.entry("functions");
    const double asked = reader.value(entry);
    if (asked != 0 && asked != 1)
      reader.refuse(entry.line, fmt::format("{} = {}: only values (1) can be had; let the driver take its gradients "
                                            "numerically",
                                            entry.tag, entry.value));
    const std::size_t colon = entry.tag.find(':');
    request.functions.push_back(
        {.descriptor = colon == std::string::npos ? entry.tag : entry.tag.substr(colon + 1), .wanted = asked == 1});
  }
  return request;
}

std::string dakota_results(const DakotaRequest& request, const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (request.functions[i].wanted) text += fmt::format("{:.17e} {}\n", values[i], request.functions[i].descriptor);
  return text;
}

}  // namespace kerf::inverse
