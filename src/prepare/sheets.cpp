// Makes parts of sheets, within which signs agree, and turns their normals outward.

#include "prepare/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kCertain = std::numeric_limits<double>::infinity();  // outweighs all votes

constexpr double kCoherent = 0.5;     // |sum v |v|| over sum v^2: votes agree; judgement
constexpr double kEnoughVotes = 0.3;  // sum v^2 of the votes v; less is chance; judgement

constexpr double kAgree = 0.96;      // |sum of signs| over their number: 98 % agree; judgement
constexpr double kMostHidden = 0.5;  // share of a sheet's points; judgement

constexpr double kOpen = 0.3;  // |sum a n| / sum a above which a part does not close; judgement
// Sine of the lean that gives an open part an upper side; judgement.
constexpr double kUpright = 0.2;

/// For each sheet the sign that nearly all of its points are known to have, relative to their
/// normals; 0: not known.
class SignsOfSheets {
 public:
  explicit SignsOfSheets(std::size_t sheets) : sums_(sheets) {}

  void add(std::uint32_t sheet, double vote) {
    sums_[sheet].signs += vote;
    sums_[sheet].all += std::abs(vote);
  }
  void add_hidden(std::uint32_t sheet) { ++sums_[sheet].hidden; }
  void count(std::uint32_t sheet) { ++sums_[sheet].points; }

  [[nodiscard]] int of(std::uint32_t sheet) const {
    const Sums& s = sums_[sheet];
    if (!(s.all > 0) || std::abs(s.signs) < kAgree * s.all) return 0;
    if (s.hidden > kMostHidden * s.points) return 0;
    return s.signs < 0 ? -1 : 1;
  }

 private:
  struct Sums {
    double signs = 0;
    double all = 0;
    double hidden = 0;
    double points = 0;
  };
  std::vector<Sums> sums_;
};

std::vector<int> known_signs(const SheetInput& input, const KnownSigns& known, const OwnSheets& own,
                             const SurfacePoints::Sheets& sheets) {
  SignsOfSheets given(sheets.part.size());
  SignsOfSheets seen(sheets.part.size());
  for (std::uint32_t i = 0; i < sheets.sheet.size(); ++i) {
    const std::uint32_t sheet = sheets.sheet[i];
    if (sheet == SurfacePoints::Sheets::kNone) continue;
    given.count(sheet);
    seen.count(sheet);
    if (!known.given.empty() && known.given[i].allFinite()) {
      const float cosine = known.given[i].dot(own.normals[i]);
      if (cosine != 0) given.add(sheet, cosine < 0 ? -1 : 1);
    }
    if (known.eye) {
      const Vector3f way = *known.eye - input.grid.points()[i];
      const float cosine = own.normals[i].dot(way.normalized());
      const bool hidden = std::isfinite(cosine > 0 ? sheets.above[i] : sheets.below[i]);
      hidden ? seen.add_hidden(sheet) : seen.add(sheet, static_cast<double>(cosine));
    }
  }
  std::vector<int> signs(sheets.part.size());
  for (std::uint32_t k = 0; k < signs.size(); ++k) {
    signs[k] = given.of(k) != 0 ? given.of(k) : seen.of(k);
  }
  return signs;
}

struct Link {
  std::uint32_t a;
  std::uint32_t b;
  double value;  // its sign: relative
};

/// Which sheets belong together, the surest first.
std::vector<Link> links_of(const std::vector<SheetVote>& votes, const std::vector<int>& known) {
  std::vector<Link> links;
  for (std::size_t k = 0; k < votes.size();) {
    Link link{votes[k].a, votes[k].b, 0};
    double squares = 0;
    for (; k < votes.size() && votes[k].a == link.a && votes[k].b == link.b; ++k) {
      const auto v = static_cast<double>(votes[k].value);
      link.value += v * std::abs(v);
      squares += v * v;
    }
    const int both = known[link.a] * known[link.b];
    if (both != 0) {
      link.value = both * kCertain;
    } else if (std::abs(link.value) < kCoherent * squares || squares <= kEnoughVotes) {
      continue;
    }
    links.push_back(link);
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
    return std::abs(x.value) > std::abs(y.value);
  });
  return links;
}

/// Sums over the points of one part.
struct PartSums {
  double area = 0;                     // m^2
  double flux = 0;                     // sum a n.p, m^3
  Vector3d vector = Vector3d::Zero();  // sum a n, m^2
  Vector3d moment = Vector3d::Zero();  // sum a p, m^3
};

/// Must the part's normals be turned round? One that closes around something gets them outward.
/// One that does not, such as terrain, a wall or one view of a scene, has no outside: its mean
/// normal is to point up (+z) or, if it lies, away from the centre of all points.
bool is_inside_out(const PartSums& part, const Vector3d& center_of_all) {
  if (!(part.area > 0)) return false;
  const Vector3d center = part.moment / part.area;
  if (part.vector.norm() <= kOpen * part.area) return part.flux - center.dot(part.vector) < 0;
  if (std::abs(part.vector.z()) > kUpright * part.vector.norm()) return part.vector.z() < 0;
  return part.vector.dot(center - center_of_all) < 0;
}

/// The sign that each part's normals are to be multiplied by where nothing is known of it.
std::vector<int> outward_signs(const SheetInput& input, const OwnSheets& own,
                               const SurfacePoints::Sheets& sheets, std::size_t parts,
                               const std::optional<Vector3d>& middle) {
  std::vector<PartSums> sums(parts);
  PartSums all;
  for (std::uint32_t i = 0; i < sheets.sheet.size(); ++i) {
    if (sheets.sheet[i] == SurfacePoints::Sheets::kNone) continue;
    const Vector3d p = input.grid.points()[i].cast<double>();
    const Vector3d n = own.normals[i].cast<double>();
    const double area =
        static_cast<double>(input.spacings[i]) * static_cast<double>(input.spacings[i]);
    PartSums& part = sums[sheets.part[sheets.sheet[i]]];
    part.area += area;
    part.flux += area * n.dot(p);
    part.vector += area * n;
    part.moment += area * p;
    all.area += area;
    all.moment += area * p;
  }
  const Vector3d own_middle = all.area > 0 ? Vector3d(all.moment / all.area) : all.moment;
  const Vector3d center = middle.value_or(own_middle);
  std::vector<int> signs;
  for (const PartSums& part : sums) signs.push_back(is_inside_out(part, center) ? -1 : 1);
  return signs;
}

/// Turns the normals of whole sheets.
void turn(const std::vector<int>& sign_of_sheet, OwnSheets& own, SurfacePoints::Sheets& sheets) {
  for (std::size_t i = 0; i < sheets.sheet.size(); ++i) {
    if (sheets.sheet[i] == SurfacePoints::Sheets::kNone || sign_of_sheet[sheets.sheet[i]] > 0)
      continue;
    own.normals[i] = -own.normals[i];
    std::swap(sheets.above[i], sheets.below[i]);
  }
}

/// Makes parts of linked sheets. A link that contradicts what is known of both of its sides is
/// passed over.
void join_parts(const SheetInput& input, const std::vector<Link>& links, std::vector<int> known,
                const std::optional<Vector3d>& middle, OwnSheets& own,
                SurfacePoints::Sheets& sheets) {
  const std::size_t count = sheets.part.size();
  detail::SignedSets sets(count);
  for (const Link& link : links) {
    const auto [root_a, sign_a] = sets.find(link.a);
    const auto [root_b, sign_b] = sets.find(link.b);
    if (root_a == root_b) continue;
    const int sign = (link.value < 0 ? -1 : 1) * sign_a * sign_b;
    const int both = known[root_a] * known[root_b];
    if (both != 0 && both != sign) continue;
    const std::uint32_t root = std::min(root_a, root_b);
    const std::uint32_t other = std::max(root_a, root_b);
    if (known[root] == 0) known[root] = sign * known[other];
    sets.join(root_a, root_b, sign);
  }
  std::vector<int> signs(count);
  std::vector<int> known_parts;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto [root, sign] = sets.find(k);
    if (root == k) {
      sheets.part[k] = static_cast<std::uint32_t>(known_parts.size());
      known_parts.push_back(known[k]);
    }
    sheets.part[k] = sheets.part[root];
    signs[k] = sign * (known[root] != 0 ? known[root] : 1);
  }
  turn(signs, own, sheets);
  const std::vector<int> outward = outward_signs(input, own, sheets, known_parts.size(), middle);
  for (std::uint32_t k = 0; k < count; ++k) {
    signs[k] = known_parts[sheets.part[k]] != 0 ? 1 : outward[sheets.part[k]];
  }
  for (const int known_part : known_parts) sheets.known.push_back(known_part != 0 ? 1 : 0);
  turn(signs, own, sheets);
}

}  // namespace

SurfacePoints::Sheets make_sheets(const SheetInput& input, const KnownSigns& known, OwnSheets& own,
                                  std::vector<Twin>& twins) {
  Growths grown = grow_sheets(input, own);
  twins = std::move(grown.twins);
  const std::vector<SheetVote> votes = look_around(input, own, grown);
  SurfacePoints::Sheets sheets = std::move(grown.sheets);
  const std::vector<int> signs = known_signs(input, known, own, sheets);
  join_parts(input, links_of(votes, signs), signs, known.middle, own, sheets);
  sheets.residual = own.residuals;
  return sheets;
}

Sheets join_sheets(const Sampling& sampling, const Radii& radii, const Weights& weights,
                   const KnownSigns& known, OwnSheets& fits) {
  if (fits.normals.empty()) return {};
  for (std::size_t i = 0; i < weights.values.size(); ++i) {
    if (weights.values[i] <= 0) fits.confidences[i] = 0;
  }
  Sheets result;
  result.sheets =
      make_sheets({sampling.grid, sampling.spacings, radii.values, sampling.local.sigmas}, known,
                  fits, result.twins);
  return result;
}

KnownSigns given_signs(const Placed& placed, const Sampling& sampling,
                       const PrepareOptions& options) {
  using Orientation = PrepareOptions::Orientation;
  const Orientation how = options.orientation;
  KnownSigns known;
  const bool seen = how == Orientation::automatic || how == Orientation::viewpoint;
  if (seen && placed.viewpoint) known.eye = (*placed.viewpoint - sampling.origin).cast<float>();
  const bool given = how == Orientation::automatic || how == Orientation::given;
  if (given && !options.viewpoint) known.given = sampling.normals;
  if (options.facts) known.middle = options.facts->extent.center() - sampling.origin;
  return known;
}

}  // namespace palpate
