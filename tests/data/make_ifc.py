#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the IFC files of this folder, each with habits of other programs, and what is true of them by construction.

Usage: tests/data/make_ifc.py      (writes ifc/*.ifc and ifc/*.golden.tsv beside itself)

A golden row is: step_id class volume_m3 closed bbox_min_xyz bbox_max_xyz status. Volumes are sums and differences of
boxes, prisms and pentagons; boxes are those of the corners.
"""
import hashlib
import math
import pathlib

LETTERS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$"
HERE = pathlib.Path(__file__).parent / "ifc"


def area(polygon):
    turned = polygon[1:] + polygon[:1]
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, turned))) / 2


def rectangle(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


class Model:
    """One file. All arguments are in metres; the file is in its own unit."""

    def __init__(self, name, schema, metre=1.0, layers=True, axis=True, reversed_loops=False, split_openings=False,
                 breps=False, elevations=True, wall_class="IFCWALL"):
        self.name, self.old, self.metre, self.layers, self.axis = name, schema == "IFC2X3", metre, layers, axis
        self.reversed_loops, self.split_openings, self.breps = reversed_loops, split_openings, breps
        self.elevations, self.wall_class, self.schema = elevations, wall_class, schema
        self.lines, self.golden, self.storeys, self.ids, self.map = [], [], [], 0, None
        new = self.add
        person = new("IFCPERSON($,$,$,$,$,$,$,$)")
        firm = new("IFCORGANIZATION($,'Someone',$,$,$)")
        both = new(f"IFCPERSONANDORGANIZATION({person},{firm},$)")
        program = new(f"IFCAPPLICATION({firm},'1','Drawing board','Board')")
        self.owner = new(f"IFCOWNERHISTORY({both},{program},$,.ADDED.,$,$,$,0)")
        self.up = new("IFCDIRECTION((0.,0.,1.))")
        self.origin = self.frame((0, 0, 0))
        prefix = ".MILLI." if metre == 1000.0 else "$"
        units = [new(f"IFCSIUNIT(*,.LENGTHUNIT.,{prefix},.METRE.)"), new("IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)")]
        units = new(f"IFCUNITASSIGNMENT(({','.join(units)}))")
        self.context = new(f"IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,{self.origin},$)")
        project = self.rooted("IFCPROJECT", f"'{name}',$,$,$,$,({self.context}),{units}")
        place = new(f"IFCLOCALPLACEMENT($,{self.origin})")
        site = self.rooted("IFCSITE", f"'site',$,$,{place},$,$,.ELEMENT.,$,$,$,$,$")
        self.placement = new(f"IFCLOCALPLACEMENT({place},{self.origin})")
        self.building = self.rooted("IFCBUILDING", f"'{name}',$,$,{self.placement},$,$,.ELEMENT.,$,$,$")
        self.group(project, [site])
        self.group(site, [self.building])

    # Entities

    def add(self, text):
        self.lines.append(text)
        return f"#{10 * len(self.lines)}"

    def guid(self):
        self.ids += 1
        bits = int(hashlib.md5(f"{self.name} {self.ids}".encode()).hexdigest(), 16)
        return "".join(LETTERS[bits >> shift & 63] for shift in range(126, -1, -6))

    def rooted(self, kind, rest):
        return self.add(f"{kind}('{self.guid()}',{self.owner},{rest})")

    def group(self, whole, parts):
        self.rooted("IFCRELAGGREGATES", f"$,$,{whole},({','.join(parts)})")

    def length(self, value):
        text = f"{value * self.metre:.6f}".rstrip("0")
        return "0." if text == "-0." else text

    def point(self, xyz):
        return self.add(f"IFCCARTESIANPOINT(({','.join(self.length(v) for v in xyz)}))")

    def direction(self, xyz):
        return self.add(f"IFCDIRECTION(({','.join(f'{v:.9f}' for v in xyz)}))")

    def frame(self, at, axis=None, reference=None):
        axes = f"{self.direction(axis)},{self.direction(reference)}" if axis else "$,$"
        return self.add(f"IFCAXIS2PLACEMENT3D({self.point(at)},{axes})")

    def placed(self, within, at, along=(1, 0)):
        return self.add(f"IFCLOCALPLACEMENT({within},{self.frame(at, (0, 0, 1), (*along, 0))})")

    # Bodies: (item, type)

    def prism(self, polygon, z0, z1):
        """Upright over a polygon; the loop runs clockwise where a program draws it so."""
        loop = polygon[::-1] if self.reversed_loops else polygon
        points = [self.point(p) for p in loop]
        line = self.add(f"IFCPOLYLINE(({','.join(points + points[:1])}))")
        profile = self.add(f"IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,{line})")
        at = self.frame((0, 0, z0))
        return self.add(f"IFCEXTRUDEDAREASOLID({profile},{at},{self.up},{self.length(z1 - z0)})")

    def upended(self, polygon, y0, y1):
        """Over a polygon of (x, z), from y0 to y1: the profile stands upright and is extruded through the wall."""
        points = [self.point(p) for p in polygon]
        line = self.add(f"IFCPOLYLINE(({','.join(points + points[:1])}))")
        profile = self.add(f"IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,{line})")
        at = self.frame((0, y1, 0), (0, -1, 0), (1, 0, 0))
        return self.add(f"IFCEXTRUDEDAREASOLID({profile},{at},{self.up},{self.length(y1 - y0)})")

    def brep(self, polygon, z0, z1):
        """The same prism by its faces; every other loop is given backwards and flagged so."""
        low = [self.point((*p, z0)) for p in polygon]
        high = [self.point((*p, z1)) for p in polygon]
        n = len(polygon)
        loops = [low[::-1], high] + [[low[i], low[(i + 1) % n], high[(i + 1) % n], high[i]] for i in range(n)]
        faces = []
        for i, loop in enumerate(loops):
            loop = self.add(f"IFCPOLYLOOP(({','.join(loop[::-1] if i % 2 else loop)}))")
            bound = self.add(f"IFCFACEOUTERBOUND({loop},{'.F.' if i % 2 else '.T.'})")
            faces.append(self.add(f"IFCFACE(({bound}))"))
        return self.add(f"IFCFACETEDBREP({self.add(f'IFCCLOSEDSHELL(({chr(44).join(faces)}))')})")

    def shape(self, items, kind="SweptSolid", more=()):
        body = self.add(f"IFCSHAPEREPRESENTATION({self.context},'Body','{kind}',({','.join(items)}))")
        return self.add(f"IFCPRODUCTDEFINITIONSHAPE($,$,({','.join([*more, body])}))")

    def mapped_box(self, x0, width, y0, y1, z0, height):
        """A box of its own for every size would be usual; here one box is scaled by what it is mapped with."""
        if self.map is None:
            unit = self.prism(rectangle(0, 0, 1, 1), 0, 1)
            shape = self.add(f"IFCSHAPEREPRESENTATION({self.context},'Body','SweptSolid',({unit}))")
            self.map = self.add(f"IFCREPRESENTATIONMAP({self.origin},{shape})")
        to = self.add(f"IFCCARTESIANTRANSFORMATIONOPERATOR3DNONUNIFORM($,$,{self.point((x0, y0, z0))},"
                      f"{width:.6f},$,{y1 - y0:.6f},{height:.6f})")
        return self.add(f"IFCMAPPEDITEM({self.map},{to})")

    def row(self, step, kind, volume, corners):
        low = [min(c[i] for c in corners) for i in range(3)]
        high = [max(c[i] for c in corners) for i in range(3)]
        numbers = "\t".join(f"{v:.4f}" for v in low + high)
        self.golden.append(f"{step[1:]}\t{kind}\t{volume:.5f}\t1\t{numbers}\tok")

    # Products

    def storey(self, name, z):
        place = self.placed(self.placement, (0, 0, z))
        elevation = self.length(z) if self.elevations else "$"
        step = self.rooted("IFCBUILDINGSTOREY", f"'{name}',$,$,{place},$,$,.ELEMENT.,{elevation}")
        self.storeys.append({"step": step, "place": place, "z": z, "products": [], "spaces": []})
        return self.storeys[-1]

    def tail(self, old, new):
        return old if self.old else new

    def wall(self, storey, a, b, thickness, height, openings=(), y0=None, name="wall", gable=0.0, z0=0.0):
        """Along a-b, the body from y0 (left is positive) over the thickness; with a gable of that height over its
        middle. Openings: (kind, start, width, sill, height)."""
        length = math.dist(a, b)
        along = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
        y0 = -thickness / 2 if y0 is None else y0
        place = self.placed(storey["place"], (*a, z0), along)
        outline = rectangle(0, y0, length, y0 + thickness)
        if gable > 0:
            body, kind = self.prism(outline, 0, height + gable + 1), "Clipping"
            slope = math.hypot(gable, length / 2)
            for sign in (-1, 1):
                top = self.frame((length / 2, 0, height + gable), (sign * gable / slope, 0, length / 2 / slope),
                                 (0, 1, 0))
                half = self.add(f"IFCHALFSPACESOLID({self.add(f'IFCPLANE({top})')},.F.)")
                body = self.add(f"IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,{body},{half})")
        elif self.breps:
            body, kind = self.brep(outline, 0, height), "Brep"
        else:
            body, kind = self.prism(outline, 0, height), "SweptSolid"
        more = []
        if self.axis:
            line = self.add(f"IFCPOLYLINE(({self.point((0, 0))},{self.point((length, 0))}))")
            more = [self.add(f"IFCSHAPEREPRESENTATION({self.context},'Axis','Curve2D',({line}))")]
        shape = self.shape([body], kind, more)
        step = self.rooted(self.wall_class, f"'{name}',$,$,{place},{shape},'{len(self.lines)}'" + self.tail("", ",$"))
        storey["products"].append(step)
        if self.layers:
            self.layer(step, thickness, y0)
        volume = thickness * (length * height + length * gable / 2)
        for what, start, width, sill, tall in openings:
            volume -= thickness * width * tall
            self.opening(storey, step, place, what, start, width, y0, thickness, sill, tall)
        local = [(x, y, z) for x, y in outline for z in (0, height)]
        local += [(length / 2, y, height + gable) for y in (y0, y0 + thickness)]
        self.row(step, self.wall_class, volume,
                 [(a[0] + x * along[0] - y * along[1], a[1] + x * along[1] + y * along[0], storey["z"] + z0 + z)
                  for x, y, z in local])
        return step

    def layer(self, step, thickness, y0):
        """Counted from the far face where y0 and thickness say so, from the near one else."""
        material = self.add("IFCMATERIAL('Kalksandstein'" + self.tail(")", ",$,$)"))
        layer = self.add(f"IFCMATERIALLAYER({material},{self.length(thickness)},$" + self.tail(")", ",$,$,$,$)"))
        layers = self.add(f"IFCMATERIALLAYERSET(({layer}),$" + self.tail(")", ",$)"))
        backwards = self.reversed_loops
        sense, offset = (".NEGATIVE.", y0 + thickness) if backwards else (".POSITIVE.", y0)
        usage = self.add(f"IFCMATERIALLAYERSETUSAGE({layers},.AXIS2.,{sense},{self.length(offset)}" +
                         self.tail(")", ",$)"))
        self.rooted("IFCRELASSOCIATESMATERIAL", f"$,$,({step}),{usage}")

    def opening(self, storey, wall, within, what, start, width, y0, thickness, sill, tall):
        if self.split_openings:  # two boxes that touch in the middle of the wall
            middle = y0 + thickness / 2
            items = [self.prism(rectangle(start, y0 - 0.05, start + width, middle), sill, sill + tall),
                     self.prism(rectangle(start, middle, start + width, y0 + thickness + 0.05), sill, sill + tall)]
        else:
            items = [self.upended(rectangle(start, sill, start + width, sill + tall), y0, y0 + thickness)]
        place = self.placed(within, (0, 0, 0))
        hole = self.rooted("IFCOPENINGELEMENT", f"'opening',$,$,{place},{self.shape(items)},$" + self.tail("", ",$"))
        self.rooted("IFCRELVOIDSELEMENT", f"$,$,{wall},{hole}")
        if what == "void":
            return
        middle = y0 + thickness / 2
        box = self.mapped_box(start, width, middle - 0.025, middle + 0.025, sill, tall)
        kind = "IFCDOOR" if what == "door" else "IFCWINDOW"
        filling = self.rooted(kind, f"'{what}',$,$,{place},{self.shape([box], 'MappedRepresentation')},$,"
                                    f"{self.length(tall)},{self.length(width)}" + self.tail("", ",$,$,$"))
        self.rooted("IFCRELFILLSELEMENT", f"$,$,{hole},{filling}")
        storey["products"].append(filling)
        self.golden.append(f"{filling[1:]}\t{kind}\t{width * tall * 0.05:.5f}\t1" + "\t0" * 6 + "\tdisputed")

    def slab(self, storey, polygon, z0, z1, holes=(), kind=".FLOOR."):
        place = self.placed(storey["place"], (0, 0, 0))
        shape = self.shape([self.prism(polygon, z0, z1)])
        step = self.rooted("IFCSLAB", f"'slab',$,$,{place},{shape},$,{kind}")
        storey["products"].append(step)
        volume = area(polygon) * (z1 - z0)
        for hole in holes:
            volume -= area(hole) * (z1 - z0)
            shape = self.shape([self.prism(hole, z0 - 0.1, z1 + 0.1)])
            hole = self.rooted("IFCOPENINGELEMENT", f"'well',$,$,{place},{shape},$" + self.tail("", ",$"))
            self.rooted("IFCRELVOIDSELEMENT", f"$,$,{step},{hole}")
        self.row(step, "IFCSLAB", volume, [(*p, storey["z"] + z) for p in polygon for z in (z0, z1)])

    def roof(self, storey, x0, x1, y_low, z_low, y_high, z_high, thickness):
        """One side of a saddle roof: a sheet along x whose lower face rises from (y_low, z_low) to (y_high, z_high)."""
        run, rise = y_high - y_low, z_high - z_low
        slope = math.hypot(run, rise)
        v = (run / slope, rise / slope)  # up the roof
        w = (-v[1], v[0]) if run > 0 else (v[1], -v[0])  # out of it
        place = self.placed(storey["place"], (0, 0, -storey["z"]))
        points = [self.point(p) for p in rectangle(0, 0, x1 - x0, slope)]
        line = self.add(f"IFCPOLYLINE(({','.join(points + points[:1])}))")
        profile = self.add(f"IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,{line})")
        if run > 0:
            at = self.frame((x0, y_low, z_low), (0, *w), (1, 0, 0))
        else:
            at = self.frame((x1, y_low, z_low), (0, *w), (-1, 0, 0))
        body = self.add(f"IFCEXTRUDEDAREASOLID({profile},{at},{self.up},{self.length(thickness)})")
        step = self.rooted("IFCSLAB", f"'roof',$,$,{place},{self.shape([body])},$,.ROOF.")
        storey["products"].append(step)
        self.row(step, "IFCSLAB", (x1 - x0) * slope * thickness,
                 [(x, y + t * w[0], z + t * w[1]) for x in (x0, x1) for t in (0, thickness)
                  for y, z in ((y_low, z_low), (y_high, z_high))])

    def column(self, storey, polygon, height):
        place = self.placed(storey["place"], (0, 0, 0))
        shape = self.shape([self.prism(polygon, 0, height)])
        step = self.rooted("IFCCOLUMN", f"'column',$,$,{place},{shape},$" + self.tail("", ",$"))
        storey["products"].append(step)
        self.row(step, "IFCCOLUMN", area(polygon) * height,
                 [(*p, storey["z"] + z) for p in polygon for z in (0, height)])

    def space(self, storey, number, name, polygon, height, walls=()):
        place = self.placed(storey["place"], (0, 0, 0))
        body = self.brep(polygon, 0, height) if self.breps else self.prism(polygon, 0, height)
        shape = self.shape([body], "Brep" if self.breps else "SweptSolid")
        step = self.rooted("IFCSPACE", f"'{number}',$,$,{place},{shape},'{name}',.ELEMENT.,.INTERNAL.,$")
        storey["spaces"].append(step)
        for wall in walls:
            self.rooted("IFCRELSPACEBOUNDARY", f"$,$,{step},{wall},$,.PHYSICAL.,.INTERNAL.")
        self.row(step, "IFCSPACE", area(polygon) * height,
                 [(*p, storey["z"] + z) for p in polygon for z in (0, height)])

    def stair(self, storey, foot, along, width, steps, tread, rise):
        """A straight flight of massive steps, its left foot at `foot`."""
        place = self.placed(storey["place"], (*foot, 0), along)
        outline = [(0, 0)]
        for i in range(steps):
            outline += [(i * tread, (i + 1) * rise), ((i + 1) * tread, (i + 1) * rise)]
        outline.append((steps * tread, 0))
        outline = outline[::-1]  # counter-clockwise in x and z
        shape = self.shape([self.upended(outline, -width, 0)])
        flight = self.rooted("IFCSTAIRFLIGHT", f"'flight',$,$,{place},{shape},$,{steps},{steps},{self.length(rise)},"
                                               f"{self.length(tread)}" + self.tail("", ",$"))
        stair = self.rooted("IFCSTAIR", f"'stair',$,$,{place},$,$,.STRAIGHT_RUN_STAIR.")
        self.group(stair, [flight])
        storey["products"].append(stair)
        self.row(flight, "IFCSTAIRFLIGHT", area(outline) * width,
                 [(foot[0] + x * along[0] - y * along[1], foot[1] + x * along[1] + y * along[0], storey["z"] + z)
                  for x in (0, steps * tread) for y in (-width, 0) for z in (0, steps * rise)])

    def ramp(self, storey, outline, y0, y1):
        """A flight over an outline of (x, z), counter-clockwise, in a ramp without a body of its own."""
        place = self.placed(storey["place"], (0, 0, 0))
        shape = self.shape([self.upended(outline, y0, y1)])
        flight = self.rooted("IFCRAMPFLIGHT", f"'flight',$,$,{place},{shape},$" + self.tail("", ",$"))
        ramp = self.rooted("IFCRAMP", f"'ramp',$,$,{place},$,$,.STRAIGHT_RUN_RAMP.")
        self.group(ramp, [flight])
        storey["products"].append(ramp)
        self.row(flight, "IFCRAMPFLIGHT", area(outline) * (y1 - y0),
                 [(x, y, storey["z"] + z) for x, z in outline for y in (y0, y1)])

    # The file

    def write(self, order=1, folded=False, comments=False):
        self.group(self.building, [s["step"] for s in self.storeys[::order]])
        for storey in self.storeys:
            if storey["products"]:
                self.rooted("IFCRELCONTAINEDINSPATIALSTRUCTURE",
                            f"$,$,({','.join(storey['products'])}),{storey['step']}")
            if storey["spaces"]:
                self.group(storey["step"], storey["spaces"])
        text = ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [CoordinationView]'),'2;1');\n"
                f"FILE_NAME('{self.name}.ifc','2000-01-01T00:00:00',(''),(''),'','Drawing board','');\n"
                f"FILE_SCHEMA(('{self.schema}'));\nENDSEC;\nDATA;\n")
        for i, line in enumerate(self.lines):
            if comments and i % 40 == 0:
                text += f"/* sheet {i // 40}; #1=IFCWALL() is none */\n"
            line = f"#{10 * (i + 1)}={line};"
            while folded and len(line) > 80:
                cut = line.rfind(",", 0, 80) + 1
                text, line = text + line[:cut] + "\n", line[cut:]
            text += line + "\n"
        (HERE / f"{self.name}.ifc").write_text(text + "ENDSEC;\nEND-ISO-10303-21;\n", "ascii")
        head = ("# by construction: step_id class volume_m3 closed bbox_min_xyz bbox_max_xyz status\n"
                "# status: ok, disputed (counted only)\n")
        (HERE / f"{self.name}.golden.tsv").write_text(head + "\n".join(self.golden) + "\n")


def twin_flats():
    """Two flats a half turn about (6, 4) apart, on two storeys, stairs in both; one door of the upper storey stands
    0.1 m from its image."""
    m = Model("twin_flats", "IFC2X3", wall_class="IFCWALLSTANDARDCASE")

    def image(p):
        return (12 - p[0], 8 - p[1])

    turns = (lambda p: p, image)
    outer = rectangle(0, 0, 12, 8)
    footing = m.storey("T/FDN", -1.5)
    for turn in turns:
        m.wall(footing, turn((0, 0.15)), turn((12, 0.15)), 0.3, 1.2, name="footing")
        m.wall(footing, turn((0.15, 7.7)), turn((0.15, 0.3)), 0.3, 1.2, name="footing")
    well = rectangle(1.2, 0.3, 4.95, 1.2)
    for level, z in ((1, 0.0), (2, 3.0)):
        storey = m.storey(f"Level {level}", z)
        holes = [well, [image(p) for p in well]] if level == 2 else []
        m.slab(storey, outer, -0.3, 0, holes)
        steps = {}
        for flat, side in (("A", 0), ("B", 1)):
            turn = turns[side]
            shift = 0.1 if level == 2 and side == 1 else 0.0
            front = [("window", 2.0, 1.5, 0.9, 1.2), ("window", 8.0, 1.2, 0.9, 1.2)]
            steps[flat, "front"] = m.wall(storey, turn((0, 0.15)), turn((12, 0.15)), 0.3, 2.7, front, name="front")
            entry = ("door", 4.7, 1.0, 0, 2.1) if level == 1 else ("window", 4.7, 1.0, 0.9, 1.2)
            steps[flat, "side"] = m.wall(storey, turn((0.15, 7.7)), turn((0.15, 0.3)), 0.3, 2.7, [entry], name="side")
            steps[flat, "inner"] = m.wall(storey, turn((0.3, 4.05)), turn((5.9, 4.05)), 0.1, 2.7,
                                          [("door", 2.0 + shift, 0.9, 0, 2.1)], name="partition")
        party = m.wall(storey, (6, 0.3), (6, 7.7), 0.2, 2.7, name="party wall")
        for flat, other, side in (("A", "B", 0), ("B", "A", 1)):
            turn = turns[side]
            near = [turn(p) for p in rectangle(0.3, 0.3, 5.9, 4.0)]
            far = [turn(p) for p in rectangle(0.3, 4.1, 5.9, 7.7)]
            names = ("Foyer", "Living Room") if level == 1 else ("Hallway", "Bedroom")
            mine = [steps[flat, "side"], steps[flat, "inner"], party]
            m.space(storey, f"{flat}{level}01", names[0], near, 2.7, [steps[flat, "front"], *mine])
            m.space(storey, f"{flat}{level}02", names[1], far, 2.7, [steps[other, "front"], *mine])
            if level == 1:
                # 15 treads and the last riser to the floor above, the left side towards the room
                m.stair(storey, turn((1.2, 1.2)), (1, 0) if side == 0 else (-1, 0), 0.9, 15, 0.25, 0.1875)
    roof = m.storey("Roof", 6.0)
    m.slab(roof, outer, -0.3, 0, kind=".ROOF.")
    for turn in turns:
        m.wall(roof, turn((0, 0.15)), turn((12, 0.15)), 0.3, 0.4, name="parapet")
        m.wall(roof, turn((0.15, 7.7)), turn((0.15, 0.3)), 0.3, 0.4, name="parapet")
    m.write(order=-1)


def gable_house():
    """One storey under a saddle roof; gables are clipped, openings are two boxes, text is folded and escaped."""
    m = Model("gable_house", "IFC4", split_openings=True)
    ground = m.storey("Erdgescho\\S\\_", 0.0)
    w = {}
    w["s"] = m.wall(ground, (0, 0), (10, 0), 0.3, 2.5, [("window", 1.5, 1.5, 0.8, 1.3), ("door", 6, 1.1, 0, 2.1)],
                    y0=0, name="S\\X\\FCd")
    w["n"] = m.wall(ground, (10, 8), (0, 8), 0.3, 2.5, [("window", 2, 1.2, 0.8, 1.3)], y0=0, name="Nord")
    w["e"] = m.wall(ground, (9.7, 0.3), (9.7, 7.7), 0.3, 2.5, [("window", 3, 1, 0.9, 1.2)], y0=-0.3, gable=2.0,
                    name="Giebel \\X2\\00F6\\X0\\stlich")
    w["w"] = m.wall(ground, (0.3, 7.7), (0.3, 0.3), 0.3, 2.5, [("window", 1, 1, 0.9, 1.2)], y0=-0.3, gable=2.0,
                    name="Giebel")
    w["m"] = m.wall(ground, (4.9, 0.3), (4.9, 7.7), 0.2, 2.5, [("door", 3.2, 0.9, 0, 2.0)], y0=-0.2, name="Trennwand")
    m.slab(ground, rectangle(0, 0, 10, 8), -0.25, 0)
    m.space(ground, "1", "K\\X\\FCche", rectangle(0.3, 0.3, 4.9, 7.7), 2.5, [w["s"], w["n"], w["w"], w["m"]])
    m.space(ground, "2", "Wohnen", rectangle(5.1, 0.3, 9.7, 7.7), 2.5, [w["s"], w["n"], w["e"], w["m"]])
    top = m.storey("Dach", 2.5)
    m.roof(top, 0, 10, 0, 2.4, 4, 4.6, 0.2)
    m.roof(top, 0, 10, 8, 2.4, 4, 4.6, 0.2)
    m.write(folded=True, comments=True)


def workshop():
    """In millimetres, clockwise profiles, layers counted from the far face, one wall aslant, storeys of no stated
    elevation, spaces without boundaries."""
    m = Model("workshop", "IFC2X3", metre=1000.0, reversed_loops=True, elevations=False)
    s = m.storey("Level 0", 0.0)
    m.wall(s, (0, 0), (16, 0), 0.25, 3.2, [("window", 1 + 3 * i, 1.5, 1, 1.4) for i in range(5)], y0=0)
    m.wall(s, (16, 10), (0, 10), 0.25, 3.2, [("door", 1.2, 1.2, 0, 2.2), ("window", 6, 2, 1, 1.4),
                                           ("door", 13, 1, 0, 2.2)], y0=0)
    m.wall(s, (16, 0.25), (16, 9.75), 0.25, 3.2, [("void", 3, 2.5, 0, 2.6)], y0=0)
    m.wall(s, (0, 9.75), (0, 0.25), 0.25, 3.2, y0=0)
    m.wall(s, (6, 0.25), (6, 9.75), 0.15, 3.2, [("door", 2, 1, 0, 2.1), ("door", 7, 1, 0, 2.1)])
    m.wall(s, (0.25, 5), (5.925, 5), 0.15, 3.2, [("door", 2.5, 0.9, 0, 2.1)])
    m.wall(s, (12, 3), (14, 4.5), 0.2, 2.4, name="screen")
    m.slab(s, rectangle(0, 0, 16, 10), -0.3, 0)
    for x in (9, 11):
        m.column(s, [(x + 0.2 * math.cos(k * math.pi / 4), 7 + 0.2 * math.sin(k * math.pi / 4)) for k in range(8)],
                 3.2)
    m.space(s, "1", "Office", rectangle(0.25, 0.25, 5.925, 4.925), 3.2)
    m.space(s, "2", "Store", rectangle(0.25, 5.075, 5.925, 9.75), 3.2)
    m.space(s, "3", "Hall", rectangle(6.075, 0.25, 15.75, 9.75), 3.2)
    m.write(folded=True)


def walls_only():
    """Bodies by their faces, no axes, layers or spaces: one room is enclosed, three walls with doors stand free."""
    m = Model("walls_only", "IFC4", layers=False, axis=False, breps=True, elevations=False)
    s = m.storey("Ebene", 0.0)
    m.wall(s, (0, 0.1), (6, 0.1), 0.2, 2.8, [("door", 2.5, 1, 0, 2.1)])
    m.wall(s, (6, 3.9), (0, 3.9), 0.2, 2.8, [("window", 1, 1.5, 0.9, 1.2), ("window", 3.5, 1.5, 0.9, 1.2)])
    m.wall(s, (5.9, 0.2), (5.9, 3.8), 0.2, 2.8)
    m.wall(s, (0.1, 3.8), (0.1, 0.2), 0.2, 2.8, [("window", 1, 1, 0.9, 1.2)])
    for i in range(3):
        doors = [("door", 0.5 + 1.5 * k, 0.9, 0, 2.1) for k in range(i + 2)]
        m.wall(s, (0, -3.0 - 2 * i), (8, -3.0 - 2 * i), 0.2, 2.8, doors, name=f"row {i}")
    m.write()


def ramp_house():
    """A room half a metre below its storey, and a ramp down to it over the whole width of the room between."""
    m = Model("ramp_house", "IFC4")
    s = m.storey("EG", 0.0)
    m.wall(s, (0, 0), (18, 0), 0.3, 3.5, y0=0, z0=-1)
    m.wall(s, (18, 7), (0, 7), 0.3, 3.5, [("window", 2, 1.2, 1.8, 1.3)], y0=0, z0=-1)
    m.wall(s, (18, 0.3), (18, 6.7), 0.3, 3.5, y0=0, z0=-1)
    m.wall(s, (0, 6.7), (0, 0.3), 0.3, 3.5, y0=0, z0=-1)
    m.wall(s, (6, 0.3), (6, 6.7), 0.2, 3.5, [("door", 2.5, 1.2, 1, 2.1)], z0=-1)
    m.wall(s, (11.5, 0.3), (11.5, 6.7), 0.2, 3.5, [("door", 2.5, 1.2, 0.5, 2.1)], z0=-1)
    m.slab(s, rectangle(0, 0, 6.1, 7), -0.2, 0)
    m.slab(s, rectangle(11.4, 0, 18, 7), -0.7, -0.5)
    m.ramp(s, [(6.1, -0.2), (11.4, -0.7), (11.4, -0.5), (6.1, 0.0)], 0.3, 6.7)
    m.slab(s, rectangle(0, 0, 18, 7), 2.5, 2.7, kind=".ROOF.")
    m.space(s, "1", "Upper", rectangle(0.3, 0.3, 5.9, 6.7), 2.5)
    m.space(s, "2", "Between", rectangle(6.1, 0.3, 11.4, 6.7), 2.5)
    m.space(s, "3", "Lower", rectangle(11.6, 0.3, 17.7, 6.7), 2.5)
    m.write()


if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    for make in (twin_flats, gable_house, workshop, walls_only, ramp_house):
        make()
