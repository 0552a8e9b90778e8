// Scenes of splats that were converted to formats of fewer bits are felt as before.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "contact/splat_trial.hpp"
#include "io/splats/splats.hpp"
#include "support/splat_files.hpp"

namespace palpate::test {
namespace {

using Forces = std::vector<Eigen::Vector3d>;

/// The shell of a file whose unit is 0.1 m: positions in SPZ are multiples of 1/4096 of a unit.
SplatShell shell_from(const std::string& bytes, io::SplatFile (*read)(const io::Input&)) {
  const ReadOptions options{.scale = 0.1};
  return shell_of(read({std::as_bytes(std::span(bytes)), "splats", options}).splats);
}

/// What a hand feels that was pressed 3 mm deep at places 15 mm from any edge of the box.
Forces presses_on(const SplatShell& shell) {
  Scene scene;
  scene.add("splats", shell.cloud);
  SceneField field(scene);
  const SplatShape shape = splat_box();
  Random random(3);
  Forces forces;
  while (forces.size() < 100) {
    const SurfacePlace place = shape.draw(random);
    if (((place.position.cwiseAbs().array() - 0.05).abs() < 0.015).count() > 1) continue;
    Proxy proxy({.stiffness = kTrialStiffness});
    proxy.reset(place.position + 0.02 * place.normal);
    for (double height = 0.02; height > -kTrialDepth; height -= kTrialSpeed * kTick) {
      const Eigen::Vector3d hand = place.position + height * place.normal;
      field.update(0, hand, proxy);
      const Contact contact = proxy.step(field, hand, kTick);
      if (height - kTrialSpeed * kTick <= -kTrialDepth) forces.push_back(contact.force);
    }
  }
  return forces;
}

/// In newtons; one press in twenty differs by more.
double most_differ_by(const Forces& a, const Forces& b) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back((a[i] - b[i]).norm());
  std::ranges::sort(differences);
  return differences[differences.size() * 19 / 20];
}

// On edges, which splats blur, a press may slide to the other side.
TEST(SplatConversions, AreFeltAsTheirOriginalsOnFaces) {
  std::vector<Splat> splats = make_splats(splat_box(), {.hidden = 0.3}, 7);
  for (Splat& splat : splats) {
    splat.position *= 10;
    splat.sigma *= 10;
  }
  const Forces original = presses_on(shell_from(splat_ply(splats), io::read_splat_ply));
  for (const Eigen::Vector3d& force : original) EXPECT_GT(force.norm(), 1);
  const Forces dot = presses_on(shell_from(dot_splat(splats), io::read_dot_splat));
  const Forces packed = presses_on(shell_from(spz(splats, 3), io::read_spz));
  EXPECT_LT(most_differ_by(original, dot), 0.05);
  EXPECT_LT(most_differ_by(original, packed), 0.1);
  RecordProperty("splat", std::to_string(most_differ_by(original, dot)));
  RecordProperty("spz", std::to_string(most_differ_by(original, packed)));
}

}  // namespace
}  // namespace palpate::test
