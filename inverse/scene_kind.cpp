#include "inverse/scene_kind.hpp"

#include "forward/bodies/scene.hpp"
#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"

namespace kerf::inverse {

namespace bodies = forward::bodies;

SceneKind SceneKind::of(const Document& scene) {
  return {.has_bodies = bodies::has_bodies(scene)};
}

const std::vector<Block>& SceneKind::blocks() const {
  return has_bodies ? bodies::scene_blocks() : forward::scene_blocks();
}

Contents SceneKind::read(const Document& scene) const {
  return (has_bodies ? scene : forward::with_preset(scene)).read(blocks());
}

void SceneKind::check(const Document& scene) const {
  if (has_bodies)
    bodies::read_scene(scene);
  else
    forward::read_scene(scene);
}

std::string SceneKind::title(const Document& scene) const {
  return has_bodies ? bodies::read_scene(scene).title : forward::read_scene(scene).title;
}

double SceneKind::cell(const Document& scene) const {
  return has_bodies ? bodies::read_scene(scene).cell : forward::read_scene(scene).cell();
}

double SceneKind::courant_number(const Document& scene) const {
  return has_bodies ? bodies::read_scene(scene).courant_number : forward::read_scene(scene).resolution.courant_number;
}

}  // namespace kerf::inverse
