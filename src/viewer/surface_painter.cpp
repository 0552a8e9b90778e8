#include "viewer/surface_painter.hpp"

#include "viewer/local_surface.hpp"
#include "viewer/surface_message.hpp"

namespace palpate::viewer {
namespace {

// A proxy that moved by less shows nothing new, in R.
constexpr double kWorthIt = 0.1;

// Between the support at which capped solids end behind their surface and that of the surface
// itself.
double least_support_of(const FieldOptions& options) {
  const bool ends = options.capped && options.kind != FieldKind::metaball && !options.raw_weights;
  return ends ? 0.5 * (options.minimum_support + options.threshold) : 0;
}

}  // namespace

SurfacePainter::SurfacePainter(Scene& scene, const Servo& servo, std::size_t device,
                               const Eigen::Vector3d& origin)
    : servo_(servo),
      device_(static_cast<std::uint8_t>(device)),
      origin_(origin),
      options_(servo.field()),
      field_(scene, options_, "the viewer") {}

PaintedSurface SurfacePainter::paint() {
  const ServoState state = servo_.state();
  if (state.step == 0) return {};
  const Eigen::Vector3d& proxy = state.contact.proxy;
  follow();
  field_.end_step(proxy, state.contact.normal);  // it is seen from where the servo's proxy is
  field_.update(state.time, state.hip, proxy);
  const double radius = field_.sample(proxy).radius;
  if (!worth_it(state, radius)) return {radius, newest_};
  const Mesh mesh = local_surface(field_, {proxy, radius, least_support_of(options_)});
  const Eigen::Vector3f center = (proxy - origin_).cast<float>();
  // An empty one takes away what a page had before.
  newest_ = std::make_shared<const std::string>(encode_surface(device_, center, mesh));
  return {radius, newest_};
}

void SurfacePainter::follow() {
  const FieldOptions options = servo_.field();
  if (options == options_) return;
  options_ = options;
  field_.change(options_);
  painted_ = false;
}

bool SurfacePainter::worth_it(const ServoState& state, double radius) {
  const Eigen::Vector3d& proxy = state.contact.proxy;
  const std::uint64_t revision = field_.traits().revision;
  const bool same =
      painted_ && revision == painted_revision_ && (proxy - painted_at_).norm() < kWorthIt * radius;
  if (same) return false;
  painted_ = true;
  painted_revision_ = revision;
  painted_at_ = proxy;
  return true;
}

}  // namespace palpate::viewer
