#!/usr/bin/env bash
# docs/modules.sh [MODULES]: draws the allowed dependencies of modules (tests/layers/modules.txt) as SVG to stdout. The test `docs` compares
# the result with docs/modules.svg. A module is above all its dependencies; an arrow leads down to each, except to those implied by
# others (transitive reduction). Colours mark the top folders, and names omit them. Lines with "has" (owners of public headers) are
# not drawn.
set -euo pipefail
modules=${1:-$(dirname "${BASH_SOURCE[0]}")/../tests/layers/modules.txt}
awk '
  function floor_of(r,   i, n, part, best, f) {
    if (r in level) return level[r]
    best = -1
    n = split(seen[r], part, " ")
    for (i = 1; i <= n; i++) { f = floor_of(part[i]); if (f > best) best = f }
    return level[r] = best + 1
  }
  function sees(from, to,   i, n, part) {
    n = split(seen[from], part, " ")
    for (i = 1; i <= n; i++) if (part[i] == to || sees(part[i], to)) return 1
    return 0
  }
  function follows(from, to,   i, n, part) { # implied by another arrow of the same module
    n = split(seen[from], part, " ")
    for (i = 1; i <= n; i++) if (part[i] != to && sees(part[i], to)) return 1
    return 0
  }
  function colour(r) {
    if (r ~ /^engine/) return "#dbe9f6"
    if (r ~ /^trace/) return "#e3f1dc"
    if (r ~ /^render/) return "#fbe8d0"
    if (r ~ /^scenarios/) return "#f1e3f3"
    if (r ~ /^bench/) return "#f8dcdc"
    if (r ~ /^tools/) return "#f5f0c4"
    return "#d9eeee"
  }
  function label(r) { sub(/^(engine|render|scenarios|bench)\//, "", r); return r }
  function put(item, f) { floor[item] = f; row[f, wide[f]++] = item }
  function link(upper, lower) { below[upper, downs[upper]++] = lower; above[lower, ups[lower]++] = upper }
  # An arrow passes through a point on each layer between its ends, which takes space like a narrow box.
  function add_arrow(from, to,   f, last, point) {
    arrows++
    last = from
    for (f = floor[from] - 1; f > floor[to]; f--) {
      point = "arrow " arrows " at " f
      put(point, f)
      size[point] = 10
      link(last, point)
      last = point
    }
    link(last, to)
    start[arrows] = from; end[arrows] = to
  }
  function mean_of(item, up, down,   i, n, sum) {
    if (up) for (i = 0; i < ups[item]; i++) { sum += x[above[item, i]]; n++ }
    if (down) for (i = 0; i < downs[item]; i++) { sum += x[below[item, i]]; n++ }
    return n ? sum / n : x[item]
  }
  function sort_row(f,   k, j, t) {
    for (k = 1; k < wide[f]; k++)
      for (j = k; j > 0 && key[row[f, j]] < key[row[f, j - 1]]; j--) { t = row[f, j]; row[f, j] = row[f, j - 1]; row[f, j - 1] = t }
  }
  function apart(one, other) { return (size[one] + size[other]) / 2 + gap }
  # Places the items of a layer as close to their preferred positions as possible without overlap: least squares, weighted by the
  # number of links. Items that would overlap form a block at their mean.
  function place_row(f,   k, r, shift, blocks, n, sum, weight, last, w) {
    for (k = 0; k < wide[f]; k++) {
      r = row[f, k]
      if (k) shift[k] = shift[k - 1] + apart(row[f, k - 1], r)
      w = ups[r] + downs[r] + 0.01
      n = ++blocks
      sum[n] = w * (key[r] - shift[k]); weight[n] = w; last[n] = k
      for (; n > 1 && sum[n - 1] / weight[n - 1] > sum[n] / weight[n]; n--) {
        sum[n - 1] += sum[n]; weight[n - 1] += weight[n]; last[n - 1] = k
      }
      blocks = n
    }
    n = 1
    for (k = 0; k < wide[f]; k++) {
      if (k > last[n]) n++
      x[row[f, k]] = sum[n] / weight[n] + shift[k]
    }
  }
  # Returns where an arrow leaves or enters a box: arrows are spread along the edge in the order of their other ends.
  function port(item, other, up,   i, n, o, place) {
    n = up ? ups[item] : downs[item]
    for (i = 0; i < n; i++) {
      o = up ? above[item, i] : below[item, i]
      if (x[o] < x[other] || (x[o] == x[other] && o < other)) place++
    }
    return x[item] + size[item] * ((place + 1) / (n + 1) - 0.5)
  }
  /^ *(#|$)/ || / has / { next }
  { split($0, half, /: */); count++; name[count] = half[1]; seen[half[1]] = half[2] }
  END {
    h = 26; dy = 70; gap = 14; left = 12; top = 46
    for (i = 1; i <= count; i++) {
      r = name[i]
      put(r, floor_of(r))
      size[r] = 8 * length(label(r)) + 18
      if (level[r] > floors) floors = level[r]
    }
    for (i = 1; i <= count; i++) {
      n = split(seen[name[i]], part, " ")
      for (j = 1; j <= n; j++) if (!follows(name[i], part[j])) add_arrow(name[i], part[j])
    }
    for (i = 1; i <= count; i++) { # arrow tips must not overlap
      r = name[i]
      if (size[r] < 11 * (ups[r] + 1)) size[r] = 11 * (ups[r] + 1)
    }
    for (f = 0; f <= floors; f++) for (k = 0; k < wide[f]; k++) x[row[f, k]] = 100 * (k - (wide[f] - 1) / 2)
    # Orders the layers alternately from below and from above, then moves items towards their neighbours.
    for (pass = 0; pass < 24; pass++)
      for (i = 0; i <= floors; i++) {
        f = pass % 2 ? floors - i : i
        for (k = 0; k < wide[f]; k++) key[row[f, k]] = mean_of(row[f, k], pass % 2, !(pass % 2))
        sort_row(f)
        place_row(f)
      }
    for (pass = 0; pass < 200; pass++)
      for (i = 0; i <= floors; i++) {
        f = pass % 2 ? floors - i : i
        for (k = 0; k < wide[f]; k++) key[row[f, k]] = mean_of(row[f, k], 1, 1)
        place_row(f)
      }
    least = 1e9; most = -1e9
    for (r in floor) {
      if (x[r] - size[r] / 2 < least) least = x[r] - size[r] / 2
      if (x[r] + size[r] / 2 > most) most = x[r] + size[r] / 2
    }
    for (r in floor) { x[r] += left - least; y[r] = top + (floors - floor[r]) * dy }
    width = most - least + 2 * left; height = top + floors * dy + h + 12
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"13\">\n", width, height, width, height
    print "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#55606c\"/></marker></defs>"
    printf "<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n", width, height
    for (i = 1; i <= arrows; i++) {
      r = start[i]
      from_x = 0
      path = ""
      last = r
      for (f = floor[r] - 1; f >= floor[end[i]]; f--) {
        next_item = f == floor[end[i]] ? end[i] : "arrow " i " at " f
        x0 = last == r ? port(r, next_item, 0) : x[last]
        y0 = y[last] + h
        x1 = next_item == end[i] ? port(end[i], last, 1) : x[next_item]
        y1 = y[next_item] - (next_item == end[i])
        path = path (last == r ? sprintf("M%.0f %.0f", x0, y0) : sprintf("L%.0f %.0f", x0, y0)) sprintf("C%.0f %.0f %.0f %.0f %.0f %.0f", x0, y0 + 20, x1, y1 - 20, x1, y1)
        last = next_item
      }
      printf "<path d=\"%s\" fill=\"none\" stroke=\"#55606c\" marker-end=\"url(#tip)\"/>\n", path
    }
    n = split("tools python/ bench/ scenarios/ render/ trace engine/", part, " ")
    for (i = 1; i <= n; i++)
      printf "<rect x=\"%d\" y=\"12\" width=\"16\" height=\"16\" rx=\"3\" fill=\"%s\" stroke=\"#55606c\"/><text x=\"%d\" y=\"25\">%s</text>\n", left + 110 * (i - 1), colour(part[i]), left + 110 * (i - 1) + 22, part[i]
    for (i = 1; i <= count; i++) {
      r = name[i]
      printf "<rect x=\"%.0f\" y=\"%.0f\" width=\"%d\" height=\"%d\" rx=\"5\" fill=\"%s\" stroke=\"#55606c\"/><text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">%s</text>\n", x[r] - size[r] / 2, y[r], size[r], h, colour(r), x[r], y[r] + 18, label(r)
    }
    print "</svg>"
  }' "$modules"
