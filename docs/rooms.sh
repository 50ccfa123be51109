#!/usr/bin/env bash
# docs/rooms.sh [ROOMS]: draws which room may see which, from tests/layers/rooms.txt, as SVG to stdout. What docs/rooms.svg
# is; the test `docs` compares. A room stands above all that it may see; an arrow leads down to what it sees.
set -euo pipefail
rooms=${1:-$(dirname "${BASH_SOURCE[0]}")/../tests/layers/rooms.txt}
awk '
  function floor_of(r,   i, n, part, best, f) {
    if (r in level) return level[r]
    best = -1
    n = split(seen[r], part, " ")
    for (i = 1; i <= n; i++) { f = floor_of(part[i]); if (f > best) best = f }
    return level[r] = best + 1
  }
  function colour(r) {
    if (r ~ /^engine/) return "#dbe9f6"
    if (r ~ /^trace/) return "#e3f1dc"
    if (r ~ /^render/) return "#fbe8d0"
    return "#f1e3f3"
  }
  /^ *(#|$)/ { next }
  { split($0, half, /: */); count++; name[count] = half[1]; seen[half[1]] = half[2] }
  END {
    w = 196; h = 26; dx = 212; dy = 74; left = 12; top = 12
    for (i = 1; i <= count; i++) { f = floor_of(name[i]); if (f > floors) floors = f; at[f, wide[f]++] = name[i] }
    for (f = 0; f <= floors; f++) if (wide[f] > widest) widest = wide[f]
    # Each floor from below is put in the order of the middles of what its rooms see.
    for (f = 0; f <= floors; f++) {
      for (k = 0; k < wide[f]; k++) {
        r = at[f, k]; n = split(seen[r], part, " "); sum = 0
        for (i = 1; i <= n; i++) sum += x[part[i]]
        key[r] = n ? sum / n : left + k * dx
      }
      for (k = 1; k < wide[f]; k++)
        for (j = k; j > 0 && key[at[f, j]] < key[at[f, j - 1]]; j--) { t = at[f, j]; at[f, j] = at[f, j - 1]; at[f, j - 1] = t }
      # As near to these middles as there is room.
      for (k = 0; k < wide[f]; k++) {
        r = at[f, k]; want = key[r]; least = k ? x[at[f, k - 1]] + dx : left; most = left + (widest - wide[f] + k) * dx
        x[r] = want < least ? least : want > most ? most : want
        y[r] = top + (floors - f) * dy
      }
    }
    width = left + widest * dx; height = top + floors * dy + h + 12
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n", width, height, width, height
    print "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#6b7785\"/></marker></defs>"
    printf "<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n", width, height
    for (i = 1; i <= count; i++) {
      r = name[i]; n = split(seen[r], part, " ")
      for (j = 1; j <= n; j++) {
        # Arrows leave along the lower edge and arrive along the upper one, spread so that they can be told apart.
        in_of[part[j]]++
      }
    }
    for (i = 1; i <= count; i++) {
      r = name[i]; n = split(seen[r], part, " ")
      for (j = 1; j <= n; j++) {
        s = part[j]; into[s]++
        x0 = x[r] + w * j / (n + 1); y0 = y[r] + h; x1 = x[s] + w * into[s] / (in_of[s] + 1); y1 = y[s]
        printf "<path d=\"M%.0f %.0fC%.0f %.0f %.0f %.0f %.0f %.0f\" fill=\"none\" stroke=\"#6b7785\" stroke-opacity=\"0.75\" marker-end=\"url(#tip)\"/>\n", x0, y0, x0, y0 + 26, x1, y1 - 26, x1, y1 - 1
      }
    }
    for (i = 1; i <= count; i++) {
      r = name[i]
      printf "<rect x=\"%.0f\" y=\"%.0f\" width=\"%d\" height=\"%d\" rx=\"5\" fill=\"%s\" stroke=\"#6b7785\"/><text x=\"%.0f\" y=\"%.0f\" text-anchor=\"middle\">%s</text>\n", x[r], y[r], w, h, colour(r), x[r] + w / 2, y[r] + 17, r
    }
    print "</svg>"
  }' "$rooms"
