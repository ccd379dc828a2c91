#pragma once

#include <cstddef>

namespace kerf::forward {

/// The named faces that a tool is built from; forces are told apart by them.
enum class ToolFace { rake, tip, bottom, lead_in, chip_breaker, sole, nose_bar };

constexpr std::size_t tool_face_count = 7;

constexpr const char* name(ToolFace face) {
  constexpr const char* names[tool_face_count] = {"rake",         "tip",  "bottom",  "lead_in",
                                                  "chip_breaker", "sole", "nose_bar"};
  return names[static_cast<std::size_t>(face)];
}

/// Force of one face of the tool on the work, N/mm, and the length in contact, mm.
struct FaceForce {
  double normal = 0, tangential = 0;
  double slip_limit = 0;  ///< `tangential` when every point slides
  double contact_length = 0;
};

}  // namespace kerf::forward
