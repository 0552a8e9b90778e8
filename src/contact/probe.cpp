#include "contact/probe.hpp"

#include "contact/texture.hpp"

namespace palpate {

Probe::Probe(const Field& field, const Texture& texture, double step_length) noexcept
    : field_(field),
      texture_(texture),
      traits_(field.traits()),
      step_length_(step_length > 0 ? step_length : 16 * traits_.resolution) {
  field_.begin_step();
}

Sample Probe::sample(const Eigen::Vector3d& x) noexcept {
  ++evaluations_;
  Sample sample = field_.sample(x);
  if (sample.radius > 0) step_length_ = sample.radius;
  if (sample.support <= 0 && sample.value <= 0) sample.value = step_length_;  // nothing known
  if (texture_.amplitude > 0) {
    const Relief relief = relief_at(texture_, x);
    sample.value -= relief.height;
    sample.gradient -= relief.gradient;
  }
  return sample;
}

bool Probe::is_free(const Ball& ball) noexcept {
  ++evaluations_;
  return field_.is_free(ball);
}

}  // namespace palpate
