// SPDX-License-Identifier: Apache-2.0
#include "bim/ifc/step_geometry.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#include <ifcpp/IFC4/include/IfcBooleanResult.h>
#include <ifcpp/IFC4/include/IfcMappedItem.h>
#include <ifcpp/IFC4/include/IfcShapeRepresentation.h>
#include <ifcpp/geometry/Carve/RepresentationConverter.h>
#include <ifcpp/model/BuildingModel.h>
#pragma GCC diagnostic pop

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

/// IFC++ reports by callback only.
void collect_complaint(void* complaints, std::shared_ptr<StatusCallback::Message> message) {
  if (!message) return;
  if (message->m_message_type != StatusCallback::MESSAGE_TYPE_ERROR &&
      message->m_message_type != StatusCallback::MESSAGE_TYPE_WARNING) {
    return;
  }
  std::string text;
  for (const wchar_t c : message->m_message_text) text += c >= 32 && c < 127 ? static_cast<char>(c) : '?';
  static_cast<std::vector<std::string>*>(complaints)->push_back(text);
}

}  // namespace

struct StepGeometry::Impl {
  explicit Impl(const std::shared_ptr<BuildingModel>& model)
      : converter(std::make_shared<GeometrySettings>(), model->getUnitConverter()) {
    converter.getGeomSettings()->setHandleStyledItems(false);  // colours
  }

  void convert(const std::shared_ptr<IfcRepresentation>& representation, const Eigen::Affine3d& X,
               std::vector<Shape>& shapes) {
    for (const auto& item : representation->m_Items) {
      if (const auto mapped = std::dynamic_pointer_cast<IfcMappedItem>(item)) {
        convert_mapped(*mapped, X, shapes);
      } else if (const auto geometric = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(item)) {
        convert_item(geometric, X, shapes);
      } else if (item) {
        complain("item of a kind that is not read: " + std::string(item->className()));
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
    convert(mapped.m_MappingSource->m_MappedRepresentation, X * X_target * X_origin, shapes);
  }

  /// A boolean difference is taken apart into its operands, whose solids are then cut elsewhere: the converter's own
  /// booleans lose parts, and not always the same ones.
  void convert_item(const std::shared_ptr<IfcGeometricRepresentationItem>& item, const Eigen::Affine3d& X,
                    std::vector<Shape>& shapes) {
    const auto boolean = std::dynamic_pointer_cast<IfcBooleanResult>(item);
    if (!boolean) {
      const auto data = std::make_shared<ItemShapeData>();
      converter.convertIfcGeometricRepresentationItem(item, data);
      for (Facets& facets : facets_of(*data)) shapes.push_back({transformed(X, std::move(facets)), {}});
      return;
    }
    if (!boolean->m_Operator || !boolean->m_FirstOperand || !boolean->m_SecondOperand) {
      return complain("a boolean result lacks an operand");
    }
    if (boolean->m_Operator->m_enum == IfcBooleanOperator::ENUM_INTERSECTION) {
      return complain("a boolean intersection is not read");
    }
    std::vector<Shape> first;
    convert_operand(boolean->m_FirstOperand, X, first);
    if (boolean->m_Operator->m_enum == IfcBooleanOperator::ENUM_UNION) {
      convert_operand(boolean->m_SecondOperand, X, first);
    } else {
      const auto second = std::make_shared<ItemShapeData>();
      converter.getSolidConverter()->convertIfcBooleanOperand(boolean->m_SecondOperand, second, nullptr);
      for (const Facets& facets : facets_of(*second))
        for (Shape& shape : first) shape.minus.push_back(transformed(X, facets));
    }
    shapes.insert(shapes.end(), first.begin(), first.end());
  }

  void convert_operand(const std::shared_ptr<IfcBooleanOperand>& operand, const Eigen::Affine3d& X,
                       std::vector<Shape>& shapes) {
    if (const auto item = std::dynamic_pointer_cast<IfcGeometricRepresentationItem>(operand)) {
      convert_item(item, X, shapes);
    } else {
      complain("operand of a kind that is not read");
    }
  }

  void complain(const std::string& text) { complaints->push_back(text); }

  RepresentationConverter converter;
  std::vector<std::string>* complaints = nullptr;
};

StepGeometry::StepGeometry(const std::shared_ptr<BuildingModel>& model) : impl_(std::make_unique<Impl>(model)) {}
StepGeometry::~StepGeometry() = default;

std::vector<Shape> StepGeometry::shapes(const std::shared_ptr<IfcRepresentation>& representation,
                                        std::vector<std::string>& complaints) {
  impl_->complaints = &complaints;
  impl_->converter.setMessageCallBack(&complaints, collect_complaint);
  std::vector<Shape> result;
  try {
    impl_->convert(representation, Eigen::Affine3d::Identity(), result);
  } catch (const std::exception& error) {  // IFC++ throws on entities it cannot make sense of
    complaints.emplace_back(error.what());
  }
  impl_->converter.unsetMessageCallBack();
  return result;
}

std::vector<Eigen::Vector3d> StepGeometry::curve(const std::shared_ptr<IfcRepresentation>& representation,
                                                 std::vector<std::string>& complaints) {
  impl_->complaints = &complaints;
  impl_->converter.setMessageCallBack(&complaints, collect_complaint);
  std::vector<Eigen::Vector3d> points;
  try {
    auto data = std::make_shared<RepresentationData>();
    impl_->converter.convertIfcRepresentation(representation, data);
    for (const auto& item : data->m_vec_item_data)
      for (const auto& line : item->m_polylines)
        for (const auto& p : line->points) points.emplace_back(p.x, p.y, p.z);
  } catch (const std::exception& error) {
    complaints.emplace_back(error.what());
  }
  impl_->converter.unsetMessageCallBack();
  return points;
}

}  // namespace plumbline::bim
