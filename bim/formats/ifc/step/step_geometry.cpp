// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_geometry.h"

#include <ifcpp/IFC4/include/IfcAxis1Placement.h>
#include <ifcpp/IFC4/include/IfcBoolean.h>
#include <ifcpp/IFC4/include/IfcBooleanResult.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcCsgPrimitive3D.h>
#include <ifcpp/IFC4/include/IfcCsgSolid.h>
#include <ifcpp/IFC4/include/IfcDirection.h>
#include <ifcpp/IFC4/include/IfcElementarySurface.h>
#include <ifcpp/IFC4/include/IfcExtrudedAreaSolidTapered.h>
#include <ifcpp/IFC4/include/IfcHalfSpaceSolid.h>
#include <ifcpp/IFC4/include/IfcMappedItem.h>
#include <ifcpp/IFC4/include/IfcPolygonalBoundedHalfSpace.h>
#include <ifcpp/IFC4/include/IfcPolygonalFaceSet.h>
#include <ifcpp/IFC4/include/IfcPositiveLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcRevolvedAreaSolid.h>
#include <ifcpp/IFC4/include/IfcRevolvedAreaSolidTapered.h>
#include <ifcpp/IFC4/include/IfcShapeRepresentation.h>
#include <ifcpp/IFC4/include/IfcSphere.h>
#include <ifcpp/IFC4/include/IfcSurfaceCurveSweptAreaSolid.h>
#include <ifcpp/IFC4/include/IfcSweptDiskSolid.h>
#include <ifcpp/geometry/Carve/RepresentationConverter.h>
#include <ifcpp/model/BuildingModel.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "bim/formats/ifc/step/half_space.h"
#include "bim/formats/ifc/step/step_conics.h"
#include "bim/formats/ifc/step/step_disk.h"
#include "bim/formats/ifc/step/step_facets.h"

namespace plumbline::bim {
namespace {

using MeshSet = carve::mesh::MeshSet<3>;

Facets facets_of(const MeshSet& meshset) {
  Facets facets;
  for (const auto& vertex : meshset.vertex_storage) facets.points.emplace_back(vertex.v.x, vertex.v.y, vertex.v.z);
  for (const carve::mesh::Mesh<3>* mesh : meshset.meshes) {
    for (const carve::mesh::Face<3>* face : mesh->faces) {
      std::vector<int>& loop = facets.loops.emplace_back();
      const carve::mesh::Edge<3>* edge = face->edge;
      for (std::size_t i = 0; i < face->n_edges; ++i, edge = edge->next)
        loop.push_back(static_cast<int>(edge->vert - meshset.vertex_storage.data()));
    }
  }
  return facets;
}

std::vector<Facets> facets_of(const ItemShapeData& item) {
  std::vector<Facets> result;
  for (const auto& meshset : item.m_meshsets)
    if (meshset) result.push_back(facets_of(*meshset));
  for (const auto& meshset : item.m_meshsets_open)
    if (meshset) result.push_back(facets_of(*meshset));
  return result;
}

Eigen::Affine3d to_eigen(const carve::math::Matrix& matrix) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  for (int column = 0; column < 4; ++column)  // carve stores columns
    for (int row = 0; row < 3; ++row) X.matrix()(row, column) = matrix.m[column][row];
  return X;
}

constexpr int circle_corners = 36, thin_circle_corners = 14;
constexpr double thin_radius_m = 0.05;

/// Of a circle; a multiple of four, so that it is as wide as it should be along both axes.
int corners_of_circle(double radius_m) {
  if (radius_m < thin_radius_m) return thin_circle_corners;
  return (arc_pieces(2.0 * std::numbers::pi, radius_m, arc_depth_m) + 3) / 4 * 4;
}

/// IFC++ reports by callback only.
void collect_diagnostic(void* diagnostics, std::shared_ptr<StatusCallback::Message> message) {
  if (!message) return;
  if (message->m_message_type != StatusCallback::MESSAGE_TYPE_ERROR &&
      message->m_message_type != StatusCallback::MESSAGE_TYPE_WARNING) {
    return;
  }
  std::string text;
  for (const wchar_t c : message->m_message_text) text += c >= 32 && c < 127 ? static_cast<char>(c) : '?';
  static_cast<std::vector<std::string>*>(diagnostics)->push_back(text);
}

}  // namespace

struct StepGeometry::Impl {
  explicit Impl(const std::shared_ptr<BuildingModel>& model)
      : converter(std::make_shared<GeometrySettings>(), model->getUnitConverter()),
        unit_m(model->getUnitConverter()->getLengthInMeterFactor()) {
    converter.getGeomSettings()->setHandleStyledItems(false);  // colours
    // Polygons in circles: 36 corners make them 0.5 % too small. Bars, pipes and handles are seen by nobody as round.
    converter.getGeomSettings()->setNumVerticesPerCircle(circle_corners);
    converter.getGeomSettings()->setNumVerticesPerCircleGivenRadius(corners_of_circle);
  }

  void convert(const std::shared_ptr<IfcRepresentation>& representation, const Eigen::Affine3d& X,
               std::vector<Shape>& shapes) {
    for (const auto& item : representation->m_Items) {
      if (const auto mapped = std::dynamic_pointer_cast<IfcMappedItem>(item)) {
        convert_mapped(*mapped, X, shapes);
      } else if (const auto geometric = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(item)) {
        convert_item(geometric, X, shapes);
      } else if (item) {
        report("item of a kind that is not read: " + std::string(item->className()));
      }
    }
  }

  void convert_mapped(const IfcMappedItem& mapped, const Eigen::Affine3d& X, std::vector<Shape>& shapes) {
    if (!mapped.m_MappingSource || !mapped.m_MappingSource->m_MappedRepresentation) return;
    std::shared_ptr<TransformData> target, origin;
    const auto& placements = converter.getPlacementConverter();
    if (mapped.m_MappingTarget) placements->convertTransformationOperator(mapped.m_MappingTarget, target);
    const auto place = std::dynamic_pointer_cast<IfcPlacement>(mapped.m_MappingSource->m_MappingOrigin);
    if (place) placements->convertIfcPlacement(place, origin);
    const Eigen::Affine3d X_target = target ? to_eigen(target->m_matrix) : Eigen::Affine3d::Identity();
    const Eigen::Affine3d X_origin = origin ? to_eigen(origin->m_matrix) : Eigen::Affine3d::Identity();
    for (const Shape& shape : once(mapped.m_MappingSource->m_MappedRepresentation))
      shapes.push_back(transformed(X * X_target * X_origin, shape));
  }

  /// A representation that many items map is converted for the first of them.
  const std::vector<Shape>& once(const std::shared_ptr<IfcRepresentation>& representation) {
    const auto [found, is_new] = converted.try_emplace(representation->m_entity_id);
    if (is_new) {
      std::vector<Shape> shapes;
      convert(representation, Eigen::Affine3d::Identity(), shapes);
      found->second = std::move(shapes);
    }
    return found->second;
  }

  /// Booleans are taken apart into their operands, whose solids are then joined elsewhere: the converter's own lose
  /// parts, and not always the same ones.
  void convert_item(const std::shared_ptr<IfcGeometricRepresentationItem>& item, const Eigen::Affine3d& X,
                    std::vector<Shape>& shapes) {
    if (const auto boolean = std::dynamic_pointer_cast<IfcBooleanResult>(item)) {
      return convert_boolean(*boolean, X, shapes);
    }
    if (const auto solid = std::dynamic_pointer_cast<IfcCsgSolid>(item)) {
      const auto root = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(solid->m_TreeRootExpression);
      return root ? convert_item(root, X, shapes) : report("a CSG solid lacks its tree");
    }
    if (const auto faces = std::dynamic_pointer_cast<IfcPolygonalFaceSet>(item)) {
      return add({polygonal_facets(*faces, unit_m, *diagnostics)}, *item, X, shapes);
    }
    if (std::dynamic_pointer_cast<IfcSurfaceCurveSweptAreaSolid>(item))
      return report("an IfcSurfaceCurveSweptAreaSolid is read along straight lines on a plane only; it is left out");
    if (std::dynamic_pointer_cast<IfcExtrudedAreaSolidTapered>(item) ||
        std::dynamic_pointer_cast<IfcRevolvedAreaSolidTapered>(item))
      report(std::string(item->className()) + " whose profiles are bent or differ in corners keeps its first profile");
    const auto disk = std::dynamic_pointer_cast<IfcSweptDiskSolid>(item);
    if (disk && disk->m_Radius)
      if (const std::vector<Eigen::Vector3d> line = points_of(disk->m_Directrix); begins_upright(line))
        return add({swept_disk(line, size_of(*disk))}, *item, X, shapes);
    const auto data = std::make_shared<ItemShapeData>();
    const auto& solids = converter.getSolidConverter();
    if (const auto half_space = std::dynamic_pointer_cast<IfcHalfSpaceSolid>(item)) {
      return convert_half_space(*half_space, X, {}, shapes);
    } else if (const auto primitive = std::dynamic_pointer_cast<IfcCsgPrimitive3D>(item)) {
      solids->convertIfcCsgPrimitive3D(in_metres(primitive), data);
    } else {
      converter.convertIfcGeometricRepresentationItem(item, data);
      if (const auto revolved = std::dynamic_pointer_cast<IfcRevolvedAreaSolid>(item)) revolve_finely(revolved, *data);
    }
    add(facets_of(*data), *item, X, shapes);
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> points_of(const std::shared_ptr<IfcCurve>& curve) {
    std::vector<carve::geom::vector<3>> points, starts;
    if (curve) converter.getCurveConverter()->convertIfcCurve(curve, points, starts);
    std::vector<Eigen::Vector3d> line;
    for (const auto& p : points) line.emplace_back(p.x, p.y, p.z);
    return line;
  }

  [[nodiscard]] SweptDisk size_of(const IfcSweptDiskSolid& disk) const {
    const double radius_m = unit_m * disk.m_Radius->m_value;
    const double inner_m = disk.m_InnerRadius ? unit_m * disk.m_InnerRadius->m_value : 0.0;
    return {radius_m, inner_m, corners_of_circle(radius_m)};
  }

  /// IFC++ takes the radius of a sphere for metres, whatever the file's unit.
  [[nodiscard]] std::shared_ptr<IfcCsgPrimitive3D> in_metres(
      const std::shared_ptr<IfcCsgPrimitive3D>& primitive) const {
    const auto sphere = std::dynamic_pointer_cast<IfcSphere>(primitive);
    if (!sphere || !sphere->m_Radius) return primitive;
    const auto scaled = std::make_shared<IfcSphere>();
    scaled->m_Position = sphere->m_Position;
    scaled->m_Radius = std::make_shared<IfcPositiveLengthMeasure>(unit_m * sphere->m_Radius->m_value);
    return scaled;
  }

  /// Again with as many corners as its radius asks for: IFC++ turns by steps of one angle whatever the radius.
  void revolve_finely(const std::shared_ptr<IfcRevolvedAreaSolid>& solid, ItemShapeData& data) {
    if (!solid->m_Axis || !solid->m_Axis->m_Location) return;
    const auto location = std::dynamic_pointer_cast<IfcCartesianPoint>(solid->m_Axis->m_Location);
    if (!location) return;
    const Eigen::Affine3d X = frame_of(solid->m_Position);
    Eigen::Vector3d origin = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
    for (std::size_t i = 0; i < std::min<std::size_t>(location->m_Coordinates.size(), 3); ++i)
      if (const auto& x = location->m_Coordinates[i]) origin[static_cast<Eigen::Index>(i)] = unit_m * x->m_value;
    if (const auto& direction = solid->m_Axis->m_Axis)
      for (std::size_t i = 0; i < std::min<std::size_t>(direction->m_DirectionRatios.size(), 3); ++i)
        if (const auto& x = direction->m_DirectionRatios[i]) axis[static_cast<Eigen::Index>(i)] = x->m_value;
    axis.normalize();
    double radius_m = 0.0;
    for (const Facets& facets : facets_of(data))
      for (const Eigen::Vector3d& p : facets.points)
        radius_m = std::max(radius_m, (X.inverse() * p - origin).cross(axis).norm());
    const int corners = corners_of_circle(radius_m);
    if (corners <= circle_corners) return;
    const auto fine = std::make_shared<ItemShapeData>();
    converter.getGeomSettings()->setNumVerticesPerCircle(corners);
    converter.convertIfcGeometricRepresentationItem(solid, fine);
    converter.getGeomSettings()->setNumVerticesPerCircle(circle_corners);
    data = *fine;
  }

  void add(std::vector<Facets> parts, const IfcRepresentationItem& item, const Eigen::Affine3d& X,
           std::vector<Shape>& shapes) {
    const std::size_t unbounded = std::erase_if(parts, [](const Facets& facets) {
      return !std::all_of(facets.points.begin(), facets.points.end(), [](const auto& p) { return p.allFinite(); });
    });
    if (unbounded > 0)
      report("an item of the class " + std::string(item.className()) +
             " has corners that are not numbers, and is left out");
    std::erase_if(parts, [](const Facets& facets) { return facets.loops.empty(); });
    if (parts.empty() && unbounded == 0)
      report("an item of the class " + std::string(item.className()) + " gives no surface");
    const OddFaces odd = parts.empty() ? OddFaces{} : odd_faces(item);
    if (odd.unread > 0)
      report(std::to_string(odd.unread) + " faces have edges along curves that are not read, and are left out");
    if (odd.curved > 0) report(std::to_string(odd.curved) + " curved faces are read as flat between their edges");
    for (Facets& facets : parts) shapes.push_back({transformed(X, std::move(facets)), {}, {}});
  }

  Eigen::Affine3d frame_of(const std::shared_ptr<IfcAxis2Placement3D>& placement) {
    std::shared_ptr<TransformData> frame;
    if (placement) converter.getPlacementConverter()->convertIfcAxis2Placement3D(placement, frame);
    return frame ? to_eigen(frame->m_matrix) : Eigen::Affine3d::Identity();
  }

  /// As much of it as can meet what lies in a box of the product's frame. (The converter's half spaces reach 100 m from
  /// wherever their plane has its origin, and come out folded where a prism runs along its plane. The box of a boxed
  /// half space is a hint for readers; it bounds nothing [iso2018, IfcBoxedHalfSpace].)
  void convert_half_space(const IfcHalfSpaceSolid& item, const Eigen::Affine3d& X, const Eigen::AlignedBox3d& around,
                          std::vector<Shape>& shapes) {
    const auto surface = std::dynamic_pointer_cast<IfcElementarySurface>(item.m_BaseSurface);
    if (!surface || !surface->m_Position || std::string_view(surface->className()) != "IfcPlane")
      return report("the half space has no plane");
    HalfSpace half_space;
    half_space.X_PS = X * frame_of(surface->m_Position);
    half_space.agreement = !item.m_AgreementFlag || item.m_AgreementFlag->m_value;
    if (const auto* bounded = dynamic_cast<const IfcPolygonalBoundedHalfSpace*>(&item)) {
      std::vector<carve::geom::vector<2>> outline, starts;
      converter.getCurveConverter()->convertIfcCurve2D(bounded->m_PolygonalBoundary, outline, starts);
      HalfSpace::Boundary& boundary = half_space.boundary.emplace(HalfSpace::Boundary{});
      boundary.X_PB = X * frame_of(bounded->m_Position);
      for (const auto& p : outline) boundary.outline.emplace_back(p.x, p.y);
    }
    constexpr double far_m = 100.0;
    const Eigen::AlignedBox3d anywhere(X.translation().array() - far_m, X.translation().array() + far_m);
    if (std::optional<Shape> shape = half_space_shape(half_space, around.isEmpty() ? anywhere : around))
      shapes.push_back(std::move(*shape));
    else
      report("the boundary of a half space has no area");
  }

  void convert_boolean(const IfcBooleanResult& boolean, const Eigen::Affine3d& X, std::vector<Shape>& shapes) {
    if (!boolean.m_Operator || !boolean.m_FirstOperand || !boolean.m_SecondOperand) {
      return report("a boolean result lacks an operand");
    }
    std::vector<Shape> first, second;
    convert_operand(boolean.m_FirstOperand, X, first);
    Eigen::AlignedBox3d around;
    for (const Shape& shape : first)
      for (const Eigen::Vector3d& p : shape.base.points) around.extend(p);
    if (const auto half_space = std::dynamic_pointer_cast<IfcHalfSpaceSolid>(boolean.m_SecondOperand))
      convert_half_space(*half_space, X, around, second);
    else
      convert_operand(boolean.m_SecondOperand, X, second);
    switch (boolean.m_Operator->m_enum) {
      case IfcBooleanOperator::ENUM_UNION:
        shapes.insert(shapes.end(), first.begin(), first.end());
        shapes.insert(shapes.end(), second.begin(), second.end());
        return;
      case IfcBooleanOperator::ENUM_DIFFERENCE:
        for (Shape& shape : first)
          for (const Shape& cut : second) shape.minus.push_back(whole_of(cut));
        shapes.insert(shapes.end(), first.begin(), first.end());
        return;
      case IfcBooleanOperator::ENUM_INTERSECTION:
        for (const Shape& shape : first) {
          for (const Shape& other : second) {
            shapes.push_back(shape);
            shapes.back().within.push_back(whole_of(other));
          }
        }
        return;
    }
  }

  /// An operand that is itself the result of booleans as the one solid it makes.
  Facets whole_of(const Shape& shape) {
    if (shape.minus.empty() && shape.within.empty()) return shape.base;
    const Solid solid = solid_of(shape, *diagnostics);
    Facets facets{solid.vertices, {}};
    for (const Eigen::Vector3i& t : solid.triangles) facets.loops.push_back({t[0], t[1], t[2]});
    return facets;
  }

  void convert_operand(const std::shared_ptr<IfcBooleanOperand>& operand, const Eigen::Affine3d& X,
                       std::vector<Shape>& shapes) {
    if (const auto item = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(operand)) {
      convert_item(item, X, shapes);
    } else {
      report("operand of a kind that is not read");
    }
  }

  /// Once a product.
  void report(const std::string& text) {
    if (std::find(diagnostics->begin(), diagnostics->end(), text) == diagnostics->end()) diagnostics->push_back(text);
  }

  RepresentationConverter converter;
  double unit_m;
  std::map<int, std::vector<Shape>> converted;  ///< mapped representations by STEP number
  std::vector<std::string>* diagnostics = nullptr;
};

StepGeometry::StepGeometry(const std::shared_ptr<BuildingModel>& model) : impl_(std::make_unique<Impl>(model)) {}
StepGeometry::~StepGeometry() = default;

std::vector<Shape> StepGeometry::shapes(const std::shared_ptr<IfcRepresentation>& representation,
                                        std::vector<std::string>& diagnostics) {
  impl_->diagnostics = &diagnostics;
  impl_->converter.setMessageCallBack(&diagnostics, collect_diagnostic);
  std::vector<Shape> result;
  try {
    impl_->convert(representation, Eigen::Affine3d::Identity(), result);
  } catch (const std::exception& error) {  // IFC++ throws on entities it cannot make sense of
    diagnostics.emplace_back(error.what());
  }
  impl_->converter.unsetMessageCallBack();
  return result;
}

std::vector<Eigen::Vector3d> StepGeometry::curve(const std::shared_ptr<IfcRepresentation>& representation,
                                                 std::vector<std::string>& diagnostics) {
  impl_->diagnostics = &diagnostics;
  impl_->converter.setMessageCallBack(&diagnostics, collect_diagnostic);
  std::vector<Eigen::Vector3d> points;
  try {
    auto data = std::make_shared<RepresentationData>();
    impl_->converter.convertIfcRepresentation(representation, data);
    for (const auto& item : data->m_vec_item_data)
      for (const auto& line : item->m_polylines)
        for (const auto& p : line->points) points.emplace_back(p.x, p.y, p.z);
  } catch (const std::exception& error) {
    diagnostics.emplace_back(error.what());
  }
  impl_->converter.unsetMessageCallBack();
  return points;
}

}  // namespace plumbline::bim
