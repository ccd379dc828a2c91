#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::inverse {

/// What Dakota asks of a black box (Dakota 6 reference manual, "Parameters file format").
struct DakotaRequest {
  std::vector<std::pair<std::string, double>> variables;  ///< descriptor and value
  struct Function {
    std::string descriptor;
    bool wanted = true;  ///< its value; active set vector 0 asks for nothing
  };
  std::vector<Function> functions;
};

/// Reads a parameters file in the standard format ("2.5 x1") or in aprepro's ("{ x1 = 2.5 }"). `name` begins messages.
/// Throws InputError for anything else, and for gradients and Hessians, which there are none of.
DakotaRequest read_dakota_request(std::string_view text, const std::string& name);

/// The results file: one wanted value per line with its descriptor.
std::string dakota_results(const DakotaRequest& request, const std::vector<double>& values);

}  // namespace kerf::inverse
