/* aabb A.obj B.obj POSES: a small collision engine with trees of axis-aligned boxes, whose queries
 * lrbscope_capture.h records if LRBCAP_OUT names a file. POSES: a line of 12 numbers for each pose of B (3x4,
 * row by row). Prints for each pose how many pairs of triangles intersect. */
#include <float.h>
#define LRBCAP_IMPLEMENTATION /* in one source file of a program */
#include <lrbscope_capture.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4 }; /* triangles of a leaf, at most */

typedef struct {
  float low[3], high[3];
  uint32_t child;        /* the first of two children, which are neighbours; 0: a leaf */
  uint32_t first, count; /* the triangles below, in `order` */
} node;

typedef struct {
  double* vertices;
  uint32_t *triangles, *order; /* order: numbers of triangles, those of a node together */
  node* nodes;
  uint32_t n_vertices, n_triangles, n_nodes;
  uint32_t tree; /* the number of the tree in the capture */
} body;

/* Bodies and pose of the current query; B is placed by x' = r x + t. */
static const body *a, *b;
static float r[3][3], abs_r[3][3], t[3];
static uint64_t pairs;

static void* grow(void* old, size_t bytes) {
  void* p = realloc(old, bytes);
  if (!p) exit(1);
  return p;
}

static void read_obj(body* m, const char* path) {
  FILE* file = fopen(path, "r");
  char line[512];
  if (!file) fprintf(stderr, "%s: cannot open the file\n", path), exit(1);
  while (fgets(line, sizeof line, file)) {
    if (line[0] == 'v' && line[1] == ' ') {
      double* v = m->vertices = grow(m->vertices, (m->n_vertices + 1) * 3 * sizeof *v);
      v += 3 * m->n_vertices++;
      sscanf(line + 2, "%lf %lf %lf", v, v + 1, v + 2);
    } else if (line[0] == 'f' && line[1] == ' ') { /* a polygon becomes a fan; "7/1/2" is vertex 7 */
      uint32_t corners[3], n = 0;
      for (char* word = strtok(line + 2, " \t\r\n"); word; word = strtok(NULL, " \t\r\n")) {
        corners[n < 2 ? n : 2] = (uint32_t)strtoul(word, NULL, 10) - 1;
        if (++n < 3) continue;
        m->triangles = grow(m->triangles, (m->n_triangles + 1) * sizeof corners);
        memcpy(m->triangles + 3 * m->n_triangles++, corners, sizeof corners);
        corners[1] = corners[2];
      }
    }
  }
  fclose(file);
  for (uint32_t i = 0; i < 3 * m->n_triangles; ++i)
    if (m->triangles[i] >= m->n_vertices) fprintf(stderr, "%s: a face without its vertex\n", path), exit(1);
  if (m->n_triangles == 0) fprintf(stderr, "%s: no faces\n", path), exit(1);
}

/* Sorts the triangles of a node by their middle along an axis. */
static const body* sorted;
static int axis;
static int by_centroid(const void* p, const void* q) {
  double d = 0;
  for (int i = 0; i < 3; ++i) {
    const uint32_t v = sorted->triangles[3 * *(const uint32_t*)p + i];
    const uint32_t w = sorted->triangles[3 * *(const uint32_t*)q + i];
    d += sorted->vertices[3 * v + axis] - sorted->vertices[3 * w + axis];
  }
  return (d > 0) - (d < 0);
}

/* Builds the tree below a node by halves along the longest side. */
static void build(body* m, uint32_t at, uint32_t first, uint32_t count) {
  node* n = m->nodes + at;
  for (int k = 0; k < 3; ++k) n->low[k] = FLT_MAX, n->high[k] = -FLT_MAX;
  for (uint32_t i = 0; i < 3 * count; ++i)
    for (int k = 0; k < 3; ++k) {
      const float x = (float)m->vertices[3 * m->triangles[3 * m->order[first + i / 3] + i % 3] + k];
      n->low[k] = fminf(n->low[k], x);
      n->high[k] = fmaxf(n->high[k], x);
    }
  n->first = first, n->count = count, n->child = 0;
  if (count <= LEAF) return;
  axis = 0;
  for (int k = 1; k < 3; ++k)
    if (n->high[k] - n->low[k] > n->high[axis] - n->low[axis]) axis = k;
  sorted = m;
  qsort(m->order + first, count, sizeof *m->order, by_centroid);
  n->child = m->n_nodes;
  m->n_nodes += 2;
  build(m, n->child, first, count / 2);
  build(m, n->child + 1, first + count / 2, count - count / 2);
}

/* Reports mesh and tree to the recorder. */
static void describe(body* m, const char* name) {
  const uint32_t n = m->n_nodes;
  uint32_t *first_child = grow(NULL, (n + 1) * 4), *child = grow(NULL, 2 * n * 4);
  uint32_t *first_prim = grow(NULL, (n + 1) * 4), *prim = grow(NULL, m->n_triangles * 4);
  float* boxes = grow(NULL, n * sizeof(float[6]));
  first_child[0] = first_prim[0] = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const node* of = m->nodes + i;
    const uint32_t c = first_child[i], p = first_prim[i], leaf = of->child ? 0 : of->count;
    if (of->child) child[c] = of->child, child[c + 1] = of->child + 1;
    memcpy(prim + p, m->order + of->first, leaf * 4);
    first_child[i + 1] = c + (of->child ? 2 : 0);
    first_prim[i + 1] = p + leaf;
    memcpy(boxes + 6 * i, of->low, sizeof of->low);
    memcpy(boxes + 6 * i + 3, of->high, sizeof of->high);
  }
  lrbcap_tree tree = {.nodes = n, .volume = LRBCAP_AABB};
  tree.first_child = first_child, tree.child = child;
  tree.first_prim = first_prim, tree.prim = prim;
  tree.float_volumes = boxes;
  tree.mesh = LRBCAP_MESH(name, m->n_vertices, m->vertices, m->n_triangles, m->triangles);
  m->tree = LRBCAP_TREE(&tree);
  free(first_child), free(child), free(first_prim), free(prim), free(boxes);
}

static void load(body* m, const char* path) {
  memset(m, 0, sizeof *m);
  read_obj(m, path);
  m->nodes = grow(NULL, 2 * m->n_triangles * sizeof(node));
  m->order = grow(NULL, m->n_triangles * sizeof *m->order);
  for (uint32_t i = 0; i < m->n_triangles; ++i) m->order[i] = i;
  m->n_nodes = 1;
  build(m, 0, 0, m->n_triangles);
  describe(m, path);
}

/* Returns an axis that separates two boxes: 0-2 of A, 3-5 of B, 6-14 products of edges; or 255. After
 * Gottschalk, Lin and Manocha 1996, section 5. */
static uint8_t separating_axis(const node* p, const node* q) {
  float h[3], g[3], d[3]; /* half axes of both, and from the centre of A's box to that of B's */
  for (int i = 0; i < 3; ++i) h[i] = (p->high[i] - p->low[i]) / 2, g[i] = (q->high[i] - q->low[i]) / 2;
  for (int i = 0; i < 3; ++i) {
    d[i] = t[i] - (p->high[i] + p->low[i]) / 2;
    for (int j = 0; j < 3; ++j) d[i] += r[i][j] * (q->high[j] + q->low[j]) / 2;
  }
  for (int i = 0; i < 3; ++i)
    if (fabsf(d[i]) > h[i] + g[0] * abs_r[i][0] + g[1] * abs_r[i][1] + g[2] * abs_r[i][2]) return (uint8_t)i;
  for (int j = 0; j < 3; ++j)
    if (fabsf(d[0] * r[0][j] + d[1] * r[1][j] + d[2] * r[2][j]) >
        g[j] + h[0] * abs_r[0][j] + h[1] * abs_r[1][j] + h[2] * abs_r[2][j])
      return (uint8_t)(3 + j);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      if (fabsf(d[i2] * r[i1][j] - d[i1] * r[i2][j]) >
          h[i1] * abs_r[i2][j] + h[i2] * abs_r[i1][j] + g[j1] * abs_r[i][j2] + g[j2] * abs_r[i][j1])
        return (uint8_t)(6 + 3 * i + j);
    }
  return LRBCAP_NO_AXIS;
}

static void cross(float* c, const float* u, const float* v) {
  for (int k = 0; k < 3; ++k) c[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
}

/* Returns 1 unless an axis separates the triangles: a normal, a product of two edges, or, for triangles in one
 * plane, a normal of an edge in that plane. In floats. */
static int triangles_meet(uint32_t f, uint32_t g) {
  float x[2][3][3], edge[2][3][3], normal[2][3], on[3];
  for (int i = 0; i < 3; ++i) {
    const double *v = a->vertices + 3 * a->triangles[3 * f + i],
                 *w = b->vertices + 3 * b->triangles[3 * g + i];
    for (int k = 0; k < 3; ++k) {
      x[0][i][k] = (float)v[k];
      x[1][i][k] = r[k][0] * (float)w[0] + r[k][1] * (float)w[1] + r[k][2] * (float)w[2] + t[k];
    }
  }
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) edge[side][i][k] = x[side][(i + 1) % 3][k] - x[side][i][k];
  for (int side = 0; side < 2; ++side) cross(normal[side], edge[side][0], edge[side][1]);
  for (int test = 0; test < 17; ++test) {
    float low[2] = {FLT_MAX, FLT_MAX}, high[2] = {-FLT_MAX, -FLT_MAX};
    if (test < 2)
      memcpy(on, normal[test], sizeof on);
    else if (test < 11)
      cross(on, edge[0][(test - 2) / 3], edge[1][(test - 2) % 3]);
    else
      cross(on, normal[(test - 11) / 3], edge[(test - 11) / 3][(test - 11) % 3]);
    for (int i = 0; i < 6; ++i) {
      const float *y = x[i / 3][i % 3], s = on[0] * y[0] + on[1] * y[1] + on[2] * y[2];
      low[i / 3] = fminf(low[i / 3], s);
      high[i / 3] = fmaxf(high[i / 3], s);
    }
    if (high[0] < low[1] || high[1] < low[0]) return 0;
  }
  return 1;
}

static float size(const node* n) {
  return n->high[0] - n->low[0] + n->high[1] - n->low[1] + n->high[2] - n->low[2];
}

static void descend(uint32_t i, uint32_t j) {
  const node *p = a->nodes + i, *q = b->nodes + j;
  const uint8_t apart = separating_axis(p, q);
  LRBCAP_NODE(i, j, apart == LRBCAP_NO_AXIS, apart);
  if (apart != LRBCAP_NO_AXIS) return;
  if (!p->child && !q->child) {
    for (uint32_t k = 0; k < p->count * q->count; ++k) {
      const uint32_t f = a->order[p->first + k / q->count], g = b->order[q->first + k % q->count];
      const int meet = triangles_meet(f, g);
      LRBCAP_PRIM(f, g, meet);
      pairs += (uint64_t)meet;
    }
  } else if (!q->child || (p->child && size(p) > size(q))) { /* open the larger one */
    descend(p->child, j);
    descend(p->child + 1, j);
  } else {
    descend(i, q->child);
    descend(i, q->child + 1);
  }
}

static void query(const double* pose) {
  for (int i = 0; i < 3; ++i) {
    t[i] = (float)pose[4 * i + 3];
    for (int j = 0; j < 3; ++j) {
      r[i][j] = (float)pose[4 * i + j];
      abs_r[i][j] = fabsf(r[i][j]) + 1e-6f; /* as parallel edges have no product */
    }
  }
  pairs = 0;
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a->tree, NULL, b->tree, pose);
  descend(0, 0);
  LRBCAP_END(pairs ? LRBCAP_INTERSECTING : LRBCAP_SEPARATE, pairs);
  printf("%llu pairs\n", (unsigned long long)pairs);
}

int main(int argc, char** argv) {
  static body first, second;
  char line[1024];
  FILE* poses = argc == 4 ? fopen(argv[3], "r") : NULL;
  if (!poses) return fprintf(stderr, "usage: aabb A.obj B.obj POSES\n"), 1;
  LRBCAP_OPEN("AABB trees in C99", NULL);
  load(&first, argv[1]);
  load(&second, argv[2]);
  a = &first, b = &second;
  while (fgets(line, sizeof line, poses)) {
    double pose[12];
    char *at = line, *end;
    int n = 0;
    for (; n < 12 && (pose[n] = strtod(at, &end), end != at); ++n) at = end;
    if (n == 12) query(pose);
  }
  fclose(poses);
  LRBCAP_CLOSE();
  return 0;
}
