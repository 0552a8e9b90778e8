#include "realtime/rig.hpp"

#include <algorithm>
#include <functional>

namespace palpate::realtime {
namespace {

constexpr double kPeriod = 1e-3;  // s

void add(const Findings& found, Findings& sum) {
  std::ranges::transform(sum.counts, found.counts, sum.counts.begin(), std::plus<>());
  if (sum.first_system_call < 0) sum.first_system_call = found.first_system_call;
}

bool finite(const Contact& contact) {
  return contact.force.allFinite() && contact.proxy.allFinite() && contact.normal.allFinite();
}

}  // namespace

Rig::Rig(Scene& scene, const FieldOptions& field, const ProxyOptions& proxy)
    : field_(scene, field), proxy_(proxy) {}

Contact Rig::step(const Eigen::Vector3d& hip) {
  if (work_) work_();
  hip_ = hip;
  now_ += kPeriod;
  Watch watch;
  field_.update(now_, hip, proxy_);
  const Contact contact = proxy_.step(field_, hip, kPeriod);
  add(watch.stop(), run_.offences);

  ++run_.steps;
  run_.touching += contact.touching ? 1 : 0;
  run_.sliding += contact.sliding ? 1 : 0;
  run_.infinite += finite(contact) ? 0 : 1;
  run_.contact_notes = run_.contact_notes | contact.notes;
  run_.field_notes = run_.field_notes | field_.notes();
  return contact;
}

void Rig::move(const Eigen::Vector3d& end, int steps) {
  const Eigen::Vector3d start = hip_;
  for (int i = 1; i <= steps; ++i) step(start + (end - start) * (static_cast<double>(i) / steps));
}

}  // namespace palpate::realtime
