// ---- colours of faces, those of the frames (render/include/lrbscope/render/style.hpp, which the page's data repeat)
const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
const mixed = (from, to, t) => from.map((c, i) => c + (to[i] - c) * t);
const WHITE = [1, 1, 1];

class Colours {
  constructor(json) {
    this.bodies = json.bodies.map(rgb);
    this.scale = json.scale.map(rgb);
    this.categories = json.categories.map(rgb);
    for (const name of ["contact", "refining", "underTest", "selected", "ink", "wrong", "wayOut"]) this[name] = rgb(json[name]);
    this.stops = json.scale;
    this.edgeInk = rgb(json.edgeInk);
    this.shares = json.shares; // how far colours move: of edges towards edgeInk, of pale faces towards white
  }

  onScale(t) {
    const at = Math.max(0, Math.min(1, t)) * (this.scale.length - 1),
      i = Math.min(Math.floor(at), this.scale.length - 2);
    return mixed(this.scale[i], this.scale[i + 1], at - i);
  }
  edge(side) {
    return mixed(this.bodies[side], this.edgeInk, this.shares.edge);
  }

  lid(side) {
    return mixed(this.bodies[side], WHITE, this.shares.lid);
  }

  /** Returns what colours faces in a mode: {of(side, face), key: {most, title} or null}. `newest`: regions of earlier layers
      are pale; 0: none is. */
  mode(bodies, by, counts, newest = 0) {
    const layers = 1 + bodies.reduce((most, b) => b.layer.reduce((m, l) => Math.max(m, l), most), 0);
    const pale = (side) => mixed(this.bodies[side], WHITE, this.shares.ground);
    if (by === "kind")
      return {
        of: (side, face) =>
          bodies[side].isReal(face) ? this.bodies[side] : this.lid(side),
        key: null,
      };
    if (by === "layer")
      return {
        of: (side, face) =>
          bodies[side].isReal(face)
            ? pale(side)
            : this.onScale(layers > 1 ? bodies[side].layer[bodies[side].inner[face]] / (layers - 1) : 1),
        key: { most: layers - 1, title: "layer" },
      };
    if (by === "region")
      return {
        of: (side, face) =>
          bodies[side].isReal(face)
            ? pale(side)
            : mixed(
                this.categories[bodies[side].inner[face] % this.categories.length],
                WHITE,
                bodies[side].layer[bodies[side].inner[face]] < newest ? 0.68 : 0,
              ),
        key: null,
      };
    const most = counts.reduce((m, values) => values.reduce((x, v) => Math.max(x, v), m), 0);
    return {
      of: (side, face) =>
        counts[side][face] > 0
          ? this.onScale(counts[side][face] / most)
          : mixed(this.bodies[side], WHITE, this.shares.noValue),
      key: { most, title: "" },
    };
  }
}
