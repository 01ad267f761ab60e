// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bim {

/// What varies in the small IFC file below. Coordinates are in its own unit.
struct SmallIfc {
  std::string unit = "#3=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);";  ///< defines #3
  std::string wall_location = "1.,2.,0.";
  std::string wall_axis = "0.,0.,1.";       ///< local z in W
  std::string wall_reference = "1.,0.,0.";  ///< local x in W
  std::string axis_line = "(0.,0.),(4.,0.)";
  std::string profile_centre = "2.,0.1";  ///< of the 4 by 0.2 body, in the wall's xy plane
  std::string offset = "0.";
  std::string sense = "POSITIVE";
  std::string thickness = "0.2";
  bool layers = true;
  bool axis = true;
  std::string storey_z = "0.";
  double scale = 1.0;  ///< of the body's own numbers
};

inline std::string number(double v) {
  std::string text = std::to_string(v);
  return text;
}

/// One storey, one wall of 4 x 0.2 x 3 with a door opening of 1 x 2 whose near edge lies 1 from the wall's origin.
inline std::string small_ifc(const SmallIfc& c) {
  const auto n = [&](double v) { return number(v * c.scale); };
  const auto pair = [](const std::string& points, std::size_t index) {
    const std::size_t split = points.find("),(");
    return index == 0 ? points.substr(0, split + 1) : points.substr(split + 2);
  };
  std::string t =
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
      "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n"
      "#1=IFCPROJECT('0000000000000000000001',$,'small',$,$,$,$,(#10),#2);\n#2=IFCUNITASSIGNMENT((#3));\n" +
      c.unit +
      "\n#10=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#11,$);\n#11=IFCAXIS2PLACEMENT3D(#12,$,$);\n"
      "#12=IFCCARTESIANPOINT((0.,0.,0.));\n"
      "#20=IFCBUILDING('0000000000000000000002',$,'b',$,$,#21,$,$,.ELEMENT.,$,$,$);\n"
      "#21=IFCLOCALPLACEMENT($,#11);\n#22=IFCRELAGGREGATES('0000000000000000000003',$,$,$,#1,(#20));\n"
      "#30=IFCBUILDINGSTOREY('0000000000000000000004',$,'ground',$,$,#31,$,$,.ELEMENT.,$);\n"
      "#31=IFCLOCALPLACEMENT(#21,#32);\n#32=IFCAXIS2PLACEMENT3D(#33,$,$);\n#33=IFCCARTESIANPOINT((0.,0.," +
      c.storey_z + "));\n#34=IFCRELAGGREGATES('0000000000000000000005',$,$,$,#20,(#30));\n";
  t += "#40=IFCWALL('0000000000000000000006',$,'wall',$,$,#41,#50,$,$);\n#41=IFCLOCALPLACEMENT(#31,#42);\n"
       "#42=IFCAXIS2PLACEMENT3D(#43,#44,#45);\n#43=IFCCARTESIANPOINT((" +
       c.wall_location + "));\n#44=IFCDIRECTION((" + c.wall_axis + "));\n#45=IFCDIRECTION((" + c.wall_reference +
       "));\n#46=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000007',$,$,$,(#40,#90),#30);\n";
  t += std::string("#50=IFCPRODUCTDEFINITIONSHAPE($,$,(") + (c.axis ? "#51," : "") + "#60));\n" +
       "#51=IFCSHAPEREPRESENTATION(#10,'Axis','Curve2D',(#52));\n#52=IFCPOLYLINE((#53,#54));\n#53=IFCCARTESIANPOINT(" +
       pair(c.axis_line, 0) + ");\n#54=IFCCARTESIANPOINT(" + pair(c.axis_line, 1) + ");\n";
  t += "#60=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#61));\n#61=IFCEXTRUDEDAREASOLID(#62,#11,#66," + n(3.0) +
       ");\n#62=IFCRECTANGLEPROFILEDEF(.AREA.,$,#63," + n(4.0) + "," + n(0.2) +
       ");\n#63=IFCAXIS2PLACEMENT2D(#64,$);\n#64=IFCCARTESIANPOINT((" + c.profile_centre +
       "));\n#66=IFCDIRECTION((0.,0.,1.));\n";
  // The opening overhangs the wall by 10 mm on either side, wherever its body lies.
  t += "#70=IFCOPENINGELEMENT('0000000000000000000008',$,'o',$,$,#71,#72,$,$);\n#71=IFCLOCALPLACEMENT(#41,#11);\n"
       "#72=IFCPRODUCTDEFINITIONSHAPE($,$,(#73));\n#73=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#74));\n"
       "#74=IFCEXTRUDEDAREASOLID(#75,#11,#66," +
       n(2.0) + ");\n#75=IFCRECTANGLEPROFILEDEF(.AREA.,$,#76," + n(1.0) + "," + n(0.22) +
       ");\n#76=IFCAXIS2PLACEMENT2D(#77,$);\n#77=IFCCARTESIANPOINT((" + n(1.5) +
       c.profile_centre.substr(c.profile_centre.find(',')) + "));\n" +
       "#78=IFCRELVOIDSELEMENT('0000000000000000000009',$,$,$,#40,#70);\n"
       "#90=IFCDOOR('0000000000000000000010',$,'door',$,$,#71,$,$,$,$,$,$,$);\n"
       "#91=IFCRELFILLSELEMENT('0000000000000000000011',$,$,$,#70,#90);\n";
  if (c.layers) {
    t += "#80=IFCRELASSOCIATESMATERIAL('0000000000000000000012',$,$,$,(#40),#81);\n"
         "#81=IFCMATERIALLAYERSETUSAGE(#82,.AXIS2.,." +
         c.sense + ".," + c.offset + ",$);\n#82=IFCMATERIALLAYERSET((#83),$,$);\n#83=IFCMATERIALLAYER(#84," +
         c.thickness + ",$,$,$,$,$);\n#84=IFCMATERIAL('brick',$,$);\n";
  }
  return t + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace plumbline::bim
