// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/traffic_editor/traffic_editor_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

/// Value of `[type, value]`, the form of a parameter in these files, or nullptr.
const Tree* parameter(const Tree& parameters, std::string_view key) {
  const Tree* pair = parameters.is_map() ? parameters.find(key) : nullptr;
  if (pair == nullptr) return nullptr;
  if (!pair->is_list() || pair->as_list().size() != 2)
    throw InputError(pair->mark, "'" + std::string(key) + "' must be [type, value]");
  return &pair->as_list()[1];
}

/// Items of an optional list; an empty map stands for an empty list in these files.
const Tree::List& items(const Tree& level, std::string_view key, const TrafficEditorConfig& config) {
  static const Tree::List none;
  const Tree* list = level.find(key);
  if (list == nullptr || list->is_null() || (list->is_map() && list->as_map().empty())) return none;
  if (list->as_list().size() > config.most_items)
    throw InputError(list->mark, "'" + std::string(key) + "' has more than " + std::to_string(config.most_items) +
                                     " entries; that is no building");
  return list->as_list();
}

double number(const Tree& tree, double furthest) {
  const double value = tree.as_double();
  if (!(std::abs(value) <= furthest))
    throw InputError(
        tree.mark, "a number between -" + format_number(furthest) + " and " + format_number(furthest) + " is expected");
  return value;
}

const Tree::List& row(const Tree& tree, std::size_t least, const std::string& form) {
  if (!tree.is_list() || tree.as_list().size() < least) throw InputError(tree.mark, form + " is expected");
  return tree.as_list();
}

class LevelReader {
 public:
  LevelReader(std::string name, const Tree& tree, bool metres, const TrafficEditorConfig& config)
      : tree_(tree), y_sign_(metres ? 1.0 : -1.0), config_(config) {
    level_.name = std::move(name);
    level_.mark = tree.mark;
  }

  TrafficLevel read() {
    if (!tree_.is_map()) throw InputError(tree_.mark, "a level must be a map with 'vertices' and 'walls'");
    if (const Tree* elevation = tree_.find("elevation")) level_.elevation_m = number(*elevation, config_.furthest_m);
    for (const Tree& vertex : items(tree_, "vertices", config_)) add_vertex(vertex);
    level_.walls = edges("walls");
    level_.doors = edges("doors");
    level_.measurements = edges("measurements");
    level_.floors = polygons("floors");
    level_.holes = polygons("holes");
    for (const Tree& fiducial : items(tree_, "fiducials", config_)) add_fiducial(fiducial);
    level_.models = items(tree_, "models", config_).size();
    return std::move(level_);
  }

 private:
  [[nodiscard]] Eigen::Vector2d point(const Tree::List& fields) const {
    // Pixels of a drawing: far more than a building has metres.
    constexpr double pixels_per_m = 1000.0;
    const double furthest = y_sign_ > 0.0 ? config_.furthest_m : pixels_per_m * config_.furthest_m;
    return {number(fields[0], furthest), y_sign_ * number(fields[1], furthest)};
  }

  void add_vertex(const Tree& tree) {
    const Tree::List& fields = row(tree, 2, "a vertex [x, y, z, name]");
    const bool named = fields.size() > 3 && fields[3].is_scalar() && !fields[3].is_null();
    level_.vertices.push_back({point(fields), named ? fields[3].as_string() : std::string()});
  }

  void add_fiducial(const Tree& tree) {
    const Tree::List& fields = row(tree, 3, "a fiducial [x, y, name]");
    level_.fiducials.push_back({point(fields), fields[2].as_string()});
  }

  [[nodiscard]] std::size_t vertex(const Tree& tree) const {
    const std::int64_t index = tree.as_int();
    if (index < 0 || static_cast<std::size_t>(index) >= level_.vertices.size())
      throw InputError(tree.mark, "there is no vertex " + std::to_string(index) + "; level '" + level_.name +
                                      "' has vertices 0 to " + std::to_string(level_.vertices.size()) + " - 1");
    return static_cast<std::size_t>(index);
  }

  [[nodiscard]] std::vector<TrafficEdge> edges(std::string_view key) const {
    std::vector<TrafficEdge> result;
    for (const Tree& tree : items(tree_, key, config_)) {
      const Tree::List& fields = row(tree, 2, "[first vertex, second vertex, parameters]");
      TrafficEdge edge{vertex(fields[0]), vertex(fields[1]), {}, 0.0, tree.mark};
      if (fields.size() > 2) {
        if (const Tree* name = parameter(fields[2], "name")) edge.name = name->as_string();
        if (const Tree* distance = parameter(fields[2], "distance"))
          edge.distance_m = number(*distance, config_.furthest_m);
      }
      result.push_back(std::move(edge));
    }
    return result;
  }

  [[nodiscard]] std::vector<std::vector<std::size_t>> polygons(std::string_view key) const {
    std::vector<std::vector<std::size_t>> result;
    for (const Tree& tree : items(tree_, key, config_)) {
      const Tree* around = tree.is_map() ? tree.find("vertices") : nullptr;
      if (around == nullptr) throw InputError(tree.mark, "an entry of '" + std::string(key) + "' needs 'vertices'");
      std::vector<std::size_t> polygon;
      for (const Tree& index : around->as_list()) polygon.push_back(vertex(index));
      result.push_back(std::move(polygon));
    }
    return result;
  }

  const Tree& tree_;
  double y_sign_;
  const TrafficEditorConfig& config_;
  TrafficLevel level_;
};

/// Metres per unit by the measurements: their mean; none without a usable one.
std::optional<double> measured_scale(const TrafficLevel& level, const TrafficEditorConfig& config,
                                     std::vector<Warning>& warnings) {
  std::vector<double> scales;
  for (const TrafficEdge& m : level.measurements) {
    const double length = (level.vertices[m.a].p_W - level.vertices[m.b].p_W).norm();
    if (m.distance_m <= 0.0 || length <= 0.0)
      throw InputError(m.mark, "a measurement needs two different vertices and a distance above 0");
    scales.push_back(m.distance_m / length);
  }
  if (scales.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double scale : scales) sum += scale;
  const auto [low, high] = std::minmax_element(scales.begin(), scales.end());
  const double mean = sum / static_cast<double>(scales.size());
  if (*high - *low > config.scale_spread * mean)
    warnings.push_back({level.name, "scale_spread",
                        "its measurements differ by " + format_number(std::round(100.0 * (*high - *low) / mean)) +
                            " %; their mean is taken"});
  return mean;
}

/// Pairs (of a level, of the reference) of equally named fiducials, in the level's order.
using PointPairs = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

PointPairs common_fiducials(const TrafficLevel& level, const TrafficLevel& reference) {
  PointPairs pairs;
  for (const TrafficFiducial& mine : level.fiducials)
    for (const TrafficFiducial& other : reference.fiducials)
      if (mine.name == other.name) {
        pairs.emplace_back(mine.p_W, other.p_W);
        break;
      }
  return pairs;
}

PointPairs centred(const PointPairs& pairs, Eigen::Vector2d& from, Eigen::Vector2d& to) {
  from = to = Eigen::Vector2d::Zero();
  for (const auto& [a, b] : pairs) {
    from += a / static_cast<double>(pairs.size());
    to += b / static_cast<double>(pairs.size());
  }
  PointPairs result;
  for (const auto& [a, b] : pairs) result.emplace_back(a - from, b - to);
  return result;
}

/// Metres per unit from fiducials shared with a level already in metres.
std::optional<double> fiducial_scale(const PointPairs& pairs) {
  Eigen::Vector2d from, to;
  double mine = 0.0, other = 0.0;
  for (const auto& [a, b] : centred(pairs, from, to)) {
    mine += a.squaredNorm();
    other += b.squaredNorm();
  }
  if (pairs.size() < 2 || mine <= 0.0 || other <= 0.0) return std::nullopt;
  return std::sqrt(other / mine);
}

template <class Move>
void move_points(TrafficLevel& level, Move&& move) {
  for (TrafficVertex& v : level.vertices) v.p_W = move(v.p_W);
  for (TrafficFiducial& f : level.fiducials) f.p_W = move(f.p_W);
}

/// Rotation and translation that lay the level's fiducials best on the reference's (least squares).
void lay_on(TrafficLevel& level, const TrafficLevel& reference, const TrafficEditorConfig& config,
            std::vector<Warning>& warnings) {
  const PointPairs pairs = common_fiducials(level, reference);
  if (pairs.empty()) {
    warnings.push_back(
        {level.name, "not_aligned",
         "no fiducial shared with '" + reference.name + "'; both drawings are taken to have the same origin"});
    return;
  }
  Eigen::Vector2d from, to;
  double c = 0.0, s = 0.0;
  for (const auto& [a, b] : centred(pairs, from, to)) {
    c += a.dot(b);
    s += a.x() * b.y() - a.y() * b.x();
  }
  const double norm = std::hypot(c, s);
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
  if (norm > 0.0) R << c / norm, -s / norm, s / norm, c / norm;
  const auto move = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d { return to + R * (p - from); };
  double worst = 0.0;
  for (const auto& [a, b] : pairs) worst = std::max(worst, (move(a) - b).norm());
  if (worst > config.fiducial_m)
    warnings.push_back({level.name, "not_aligned",
                        "a fiducial is " + format_number(std::round(100.0 * worst) / 100.0) + " m off that of '" +
                            reference.name + "'"});
  move_points(level, move);
}

}  // namespace

TrafficFile read_traffic_file(const Tree& tree, const TrafficEditorConfig& config) {
  const Tree* levels = tree.is_map() ? tree.find("levels") : nullptr;
  if (levels == nullptr || !levels->is_map() || levels->as_map().empty())
    throw InputError(levels != nullptr ? levels->mark : tree.mark,
                     "a traffic-editor plan needs 'levels', a map of at least one level");
  TrafficFile file;
  if (const Tree* name = tree.find("name")) file.name = name->as_string();
  if (const Tree* system = tree.find("coordinate_system")) {
    file.metres = system->as_string() == "cartesian_meters";
    if (!file.metres && system->as_string() != "reference_image")
      throw InputError(system->mark, "coordinate_system '" + system->as_string() +
                                         "' is not read; it must be reference_image or cartesian_meters");
  }
  for (const auto& [name, level] : levels->as_map())
    file.levels.push_back(LevelReader(name, level, file.metres, config).read());
  std::stable_sort(file.levels.begin(), file.levels.end(), [](const TrafficLevel& a, const TrafficLevel& b) {
    return std::pair(a.elevation_m, a.name) < std::pair(b.elevation_m, b.name);
  });
  if (const Tree* lifts = tree.find("lifts"); lifts != nullptr && lifts->is_map())
    for (const auto& [name, lift] : lifts->as_map()) file.lifts.push_back(name);
  return file;
}

void align_levels(TrafficFile& file, const TrafficEditorConfig& config, std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < file.levels.size(); ++i) {
    TrafficLevel& level = file.levels[i];
    std::optional<double> scale = file.metres ? 1.0 : measured_scale(level, config, warnings);
    if (!scale && i > 0) scale = fiducial_scale(common_fiducials(level, file.levels.front()));
    if (!scale)
      throw InputError(level.mark, "level '" + level.name + "' has no scale; draw a measurement on it" +
                                       (i > 0 ? ", or two fiducials that the lowest level has" : ""));
    move_points(level, [&](const Eigen::Vector2d& p) -> Eigen::Vector2d { return *scale * p; });
    for (const TrafficVertex& v : level.vertices)
      if (!(v.p_W.cwiseAbs().maxCoeff() <= config.furthest_m))
        throw InputError(level.mark, "level '" + level.name + "' reaches further than " +
                                         format_number(config.furthest_m) + " m; check its measurements");
    if (i > 0) lay_on(level, file.levels.front(), config, warnings);
  }
}

}  // namespace plumbline::bim
