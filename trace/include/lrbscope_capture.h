/* lrbscope_capture.h 1.0: records what a collision engine does, for `lrbscope import`.
 *
 * One header in C99 or C++11 that needs only the C library. Copy it, or include the installed one.
 * - Without LRBCAP_ENABLE, the macros below do nothing: arguments are not evaluated, and the program contains
 *   no trace of it.
 * - With LRBCAP_ENABLE, exactly one source file defines LRBCAP_IMPLEMENTATION before it includes this header.
 *   Nothing is recorded unless the environment variable LRBCAP_OUT names a file.
 *
 *   LRBCAP_OPEN("my engine 1.2", NULL);
 *   uint32_t mesh = LRBCAP_MESH("cow", n_vertices, xyz, n_triangles, corners);
 *   uint32_t tree = LRBCAP_TREE(&description);                        an lrbcap_tree; of several: LRBCAP_INSTANCES
 *   LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, tree_a, pose_a, tree_b, pose_b);   12 doubles each: 3x4, row by row
 *     LRBCAP_NODE(i, j, met, axis);                                   two bounding volumes were tested
 *     LRBCAP_PRIM(f, g, met);                                         two triangles were tested
 *   LRBCAP_END(LRBCAP_INTERSECTING, n_pairs);                         the engine's own answer
 *   LRBCAP_CLOSE();
 *
 * Threads: each has its own buffer (215 kB). Open, describe and close while no query runs; everything else
 * may be called by several threads at once, each with queries of its own. A thread that helps with the query
 * of another calls LRBCAP_JOIN(query), later LRBCAP_JOIN(0), and before it exits LRBCAP_THREAD_END(). Queries
 * do not nest: one that begins within another leaves the other without an end.
 *
 * Output is only appended: to a file, a FIFO, or your own function (LRBCAP_OPEN_SINK).
 *   LRBCAP_OUT=FILE            where; without it nothing is recorded
 *   LRBCAP_QUERIES=40-60       only these queries, numbered from 1 (also 40 or 40-)
 *   LRBCAP_EVERY=N             one query, at random, of N in succession
 *   LRBCAP_SLOWER_US=N         events only of queries that take at least N microseconds, or have over 8,192
 *   LRBCAP_EVENTS=0            no tests of nodes and triangles: queries, times, counters and phases only
 *   LRBCAP_MAX_MB=N            after N megabytes no events, after N + N/8 no queries; 0: no limit; default 4096
 *
 * docs/capture.md of lrbscope describes calls and file format, and what versions 1.x keep.
 *
 * MIT License. Copyright (c) 2026 The lrbscope authors
 *
 * Permission is hereby granted, free of charge, to any person obtaining a copy of this software and
 * associated documentation files (the "Software"), to deal in the Software without restriction, including
 * without limitation the rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
 * copies of the Software, and to permit persons to whom the Software is furnished to do so, subject to the
 * following conditions: The above copyright notice and this permission notice shall be included in all copies
 * or substantial portions of the Software.
 *
 * THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT
 * LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO
 * EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER
 * IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE
 * USE OR OTHER DEALINGS IN THE SOFTWARE. */
#ifndef LRBSCOPE_CAPTURE_H
#define LRBSCOPE_CAPTURE_H
#include <stddef.h>
#include <stdint.h>
#ifdef __clang__ /* for users of -Weverything */
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wunknown-warning-option"
#pragma clang diagnostic ignored "-Wcomma"
#pragma clang diagnostic ignored "-Wdeclaration-after-statement"
#pragma clang diagnostic ignored "-Wpadded"
#pragma clang diagnostic ignored "-Wunsafe-buffer-usage"
#pragma clang diagnostic ignored "-Wzero-as-null-pointer-constant"
#endif

/* Kinds of queries. LRBCAP_SELF: one tree with itself. LRBCAP_SHAPE: a tree with a shape, whose tree has one
 * node, and whose triangles are for pictures only; events name its node 0 and its triangle 0. */
enum {
  LRBCAP_ALL_PAIRS = 1,
  LRBCAP_ANY = 2,
  LRBCAP_DISTANCE = 3,
  LRBCAP_FIRST_CONTACT = 4,
  LRBCAP_SELF = 5,
  LRBCAP_SHAPE = 6
};
/* The engine's answer. */
enum { LRBCAP_SEPARATE = 0, LRBCAP_INTERSECTING = 1, LRBCAP_UNREPORTED = 2 };
/* The axis on which two volumes are apart: 0-2 axes of A, 3-5 axes of B, 6-14 cross products of edges
 * (6 + 3 i + j), 32 + k direction k of a k-DOP. */
enum { LRBCAP_NO_AXIS = 255 };
/* Bounding volumes, and their numbers in the frame of the mesh. */
enum {
  LRBCAP_AABB = 1,   /* 6: least x, y, z; greatest x, y, z */
  LRBCAP_SPHERE = 2, /* 4: centre, radius */
  LRBCAP_OBB = 3,    /* 12: centre, three half axes */
  LRBCAP_RSS = 4,    /* 10: a corner of the rectangle, its two sides as vectors, radius */
  LRBCAP_KDOP = 5,   /* 2 k: for each direction the least and the greatest product with it */
  /* Added to one of these but spheres and RSS, for a tree with spatial splits: a triangle may be in several leaves, and
   * the volumes of each contain a part of it. */
  LRBCAP_SPLITS = 256
};

/* A tree of n nodes. Node 0 is the root. Set unused members to zero. */
typedef struct lrbcap_tree {
  uint32_t mesh;       /* result of LRBCAP_MESH */
  uint32_t replaces;   /* result of LRBCAP_TREE for the tree that this one refits or replaces; 0: none */
  uint32_t nodes;      /* n */
  uint32_t volume;     /* LRBCAP_AABB ..., with LRBCAP_SPLITS or without */
  uint32_t directions; /* k of a k-DOP */
  const uint32_t* ids; /* n numbers by which events name the nodes; NULL: 0, 1, 2 ... */
  const uint32_t* first_child; /* n + 1: node i has child[first_child[i]] to child[first_child[i + 1] - 1] */
  const uint32_t* child;       /* indices of nodes, not ids */
  const uint32_t* first_prim;  /* n + 1: the same for the triangles of leaves */
  const uint32_t* prim;
  const double* volumes;      /* n times the numbers of the volume */
  const float* float_volumes; /* the same as floats, used if volumes is NULL */
  const double* direction;    /* 3 k of a k-DOP */
} lrbcap_tree;

/* Receives the bytes of a capture in order, one call at a time. Returns 0 to end the recording. */
typedef int (*lrbcap_sink)(void* user, const void* bytes, uint64_t size);

#if defined(_MSC_VER) && !defined(__clang__)
#define LRBCAP_INLINE static __forceinline
#define LRBCAP_THREAD_LOCAL __declspec(thread)
#define LRBCAP_UNLIKELY(x) (x)
#else
#define LRBCAP_INLINE static inline __attribute__((always_inline, unused))
#define LRBCAP_THREAD_LOCAL __thread
#define LRBCAP_UNLIKELY(x) __builtin_expect(!!(x), 0)
#endif
#ifdef __cplusplus
#define LRBCAP_CAST(type, x) static_cast<type>(x)
extern "C" {
#else
#define LRBCAP_CAST(type, x) ((type)(x))
#endif

/* Calls of functions without and with a result. Operands of sizeof are checked and count as used, but are not
 * evaluated. */
#ifdef LRBCAP_ENABLE
#define LRBCAP_CALL(call) call
#define LRBCAP_RESULT(call) call
#else
LRBCAP_INLINE uint32_t lrbcap_none(size_t size) {
  (void)size;
  return 0;
}
#define LRBCAP_CALL(call) ((void)sizeof(call, 0))
#define LRBCAP_RESULT(call) lrbcap_none(sizeof(call))
#endif

/* Starts to record to a file: path, or if that is NULL, $LRBCAP_OUT; without both, nothing is recorded. A
 * file that is still open at exit is closed then. With a sink, bytes go to it, and LRBCAP_CLOSE must follow.
 */
#define LRBCAP_OPEN(engine, path) LRBCAP_CALL(lrbcap_open(engine, path, NULL, NULL))
#define LRBCAP_OPEN_SINK(engine, sink, user) LRBCAP_CALL(lrbcap_open(engine, NULL, sink, user))
#define LRBCAP_CLOSE() LRBCAP_CALL(lrbcap_close())
/* After OPEN: records one query, at random, of n in succession. `check` scales its sums by n. */
#define LRBCAP_EVERY(n) LRBCAP_CALL(lrbcap_every(LRBCAP_CAST(uint64_t, n)))

/* Describe a mesh (3 doubles per vertex, 3 indices per triangle), a tree, and the name of a counter or phase.
 * They return a number above 0, or 0 if nothing is recorded. The data may be freed afterwards. */
#define LRBCAP_MESH(name, n_vertices, xyz, n_triangles, corners)          \
  LRBCAP_RESULT(lrbcap_mesh(name, LRBCAP_CAST(uint32_t, n_vertices), xyz, \
                            LRBCAP_CAST(uint32_t, n_triangles), corners))
#define LRBCAP_TREE(tree) LRBCAP_RESULT(lrbcap_add_tree(tree))
#define LRBCAP_NAME(name) LRBCAP_RESULT(lrbcap_name(name))
/* Describe a tree of instances: `tree` without a mesh, whose leaves have instances in place of triangles. Of each of
 * the n instances: the tree of its body, and a pose, 12 doubles, from the frame of the body to that of `tree`, which
 * may have a scale. Returns the number of a tree. */
#define LRBCAP_INSTANCES(name, tree, n, bodies, poses) \
  LRBCAP_RESULT(lrbcap_instances(name, tree, LRBCAP_CAST(uint32_t, n), bodies, poses))

/* Begin and end a query. Tree 0: a single triangle or shape. Pose NULL: the identity. BEGIN returns the
 * number of the query for LRBCAP_JOIN, or 0 if it is not recorded. pairs: how many the engine found. */
#define LRBCAP_BEGIN(kind, tree_a, pose_a, tree_b, pose_b) \
  LRBCAP_RESULT(lrbcap_begin(kind, tree_a, pose_a, tree_b, pose_b))
/* Begin a query of one tree with a ray, a point or a box of the world; tests name it 0, as b. Kinds: ALL_PAIRS for
 * all triangles that are hit, ANY, or DISTANCE: for a ray its first hit, whose VALUE is the multiple of the direction.
 * ray: 8 doubles, origin, direction, the least and the greatest multiple of it (HUGE_VAL: no end); point: x, y, z;
 * box: 6 doubles, least and greatest x, y, z. */
#define LRBCAP_RAY(kind, tree, pose, ray) LRBCAP_BEGIN(LRBCAP_CAST(uint32_t, kind) | 256u, tree, pose, 0, ray)
#define LRBCAP_POINT(kind, tree, pose, point) LRBCAP_BEGIN(LRBCAP_CAST(uint32_t, kind) | 512u, tree, pose, 0, point)
#define LRBCAP_BOX(kind, tree, pose, box) LRBCAP_BEGIN(LRBCAP_CAST(uint32_t, kind) | 768u, tree, pose, 0, box)
#define LRBCAP_END(verdict, pairs) \
  LRBCAP_CALL(lrbcap_end(LRBCAP_CAST(uint32_t, verdict), LRBCAP_CAST(uint64_t, pairs)))
/* Before the END of a query of kind DISTANCE: the engine's distance, which is between these bounds. */
#define LRBCAP_VALUE(lower, upper) LRBCAP_CALL(lrbcap_value(lower, upper))
/* This thread helps with a query that another one began; 0: no longer. */
#define LRBCAP_JOIN(query) LRBCAP_CALL(lrbcap_join(query))
#define LRBCAP_THREAD_END() LRBCAP_CALL(lrbcap_thread_end())

/* Tests, in the engine's order: a of tree or mesh A, b of B; met: whether they overlap. NODES: several tests
 * at once (wide nodes; at most 255), `met` of which found an overlap. */
#define LRBCAP_NODE(a, b, met, axis) LRBCAP_EVENT(LRBCAP_KIND_NODES, a, b, 1, (met) ? 1 : 0, axis)
#define LRBCAP_NODES(a, b, tests, met, axis) LRBCAP_EVENT(LRBCAP_KIND_NODES, a, b, tests, met, axis)
#define LRBCAP_PRIM(a, b, met) LRBCAP_EVENT(LRBCAP_KIND_PRIMS, a, b, 1, (met) ? 1 : 0, LRBCAP_NO_AXIS)
/* From here on, tests name the nodes and triangles of instance a of A and of instance b of B, from 0; LRBCAP_TOP: the
 * nodes of the tree of instances, as when a query begins, and for a side without instances. */
#define LRBCAP_TOP 0xFFFFFFFFu
#define LRBCAP_ENTER(a, b) LRBCAP_EVENT(LRBCAP_KIND_NODES, a, b, 0, 0, LRBCAP_NO_AXIS)
/* A counter of the engine, and the beginning of a phase. name: result of LRBCAP_NAME. */
#define LRBCAP_COUNT(name, value) LRBCAP_EVENT(LRBCAP_KIND_COUNT, name, value, 1, 0, LRBCAP_NO_AXIS)
#define LRBCAP_PHASE(name) LRBCAP_EVENT(LRBCAP_KIND_PHASE, name, 0, 1, 0, LRBCAP_NO_AXIS)

/* ---- The rest is not for callers. */

#define LRBCAP_EVENT(kind, a, b, tests, met, axis)                                  \
  LRBCAP_CALL(lrbcap_push(kind, LRBCAP_CAST(uint32_t, a), LRBCAP_CAST(uint32_t, b), \
                          LRBCAP_CAST(uint8_t, tests), LRBCAP_CAST(uint8_t, met),   \
                          LRBCAP_CAST(uint8_t, axis)))
enum { LRBCAP_KIND_NODES = 0, LRBCAP_KIND_PRIMS = 1, LRBCAP_KIND_COUNT = 2, LRBCAP_KIND_PHASE = 3 };

void lrbcap_open(const char* engine, const char* path, lrbcap_sink sink, void* user);
void lrbcap_close(void);
void lrbcap_every(uint64_t n);
uint32_t lrbcap_mesh(const char* name, uint32_t n_vertices, const double* xyz, uint32_t n_triangles,
                     const uint32_t* corners);
uint32_t lrbcap_add_tree(const lrbcap_tree* tree);
uint32_t lrbcap_instances(const char* name, const lrbcap_tree* tree, uint32_t n, const uint32_t* bodies,
                          const double* poses);
uint32_t lrbcap_name(const char* name);
uint32_t lrbcap_begin(uint32_t kind, uint32_t tree_a, const double* pose_a, uint32_t tree_b,
                      const double* pose_b);
void lrbcap_value(double lower, double upper);
void lrbcap_end(uint32_t verdict, uint64_t pairs);
void lrbcap_join(uint32_t query);
void lrbcap_thread_end(void);

#ifndef LRBCAP_ENABLE
void lrbcap_push(uint8_t kind, uint32_t a, uint32_t b, uint8_t tests, uint8_t met, uint8_t axis);
#else
typedef struct lrbcap_event { /* 12 bytes; 3 to 14 in the file */
  uint32_t a, b;
  uint32_t what; /* from the lowest byte: kind, tests, met, axis */
} lrbcap_event;
typedef struct lrbcap_buffer {
  lrbcap_event *next, *last; /* where the next event goes; the last place */
  uint32_t notes;            /* how many of the events are counters and phases */
} lrbcap_buffer;
extern LRBCAP_THREAD_LOCAL lrbcap_buffer* lrbcap_now; /* NULL: this thread is in no recorded query */
void lrbcap_full(void);
LRBCAP_INLINE void lrbcap_push(uint8_t kind, uint32_t a, uint32_t b, uint8_t tests, uint8_t met,
                               uint8_t axis) {
  lrbcap_buffer* const buffer = lrbcap_now;
  if (LRBCAP_UNLIKELY(buffer != NULL)) {
    lrbcap_event* const e = buffer->next;
    e->a = a;
    e->b = b;
    e->what = kind | LRBCAP_CAST(uint32_t, tests) << 8 | LRBCAP_CAST(uint32_t, met) << 16 |
              LRBCAP_CAST(uint32_t, axis) << 24;
    if (kind >= LRBCAP_KIND_COUNT) ++buffer->notes;
    buffer->next = e + 1;
    if (LRBCAP_UNLIKELY(e == buffer->last)) lrbcap_full();
  }
}
#endif
#ifdef __cplusplus
}
#endif

#if defined(LRBCAP_ENABLE) && defined(LRBCAP_IMPLEMENTATION)
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#if defined(__unix__) || defined(__APPLE__) || defined(__MINGW32__)
#include <sys/time.h>
#endif
#ifdef _MSC_VER
#include <intrin.h>
#pragma warning(push)
#pragma warning(disable : 4996) /* getenv and fopen */
#endif

/* ---- Time: a fast counter of the processor, and the wall clock to which the reader relates it. */

static uint64_t lrbcap_wall_ns(void) {
#if defined(__unix__) || defined(__APPLE__) || defined(__MINGW32__)
  struct timeval t; /* as strict C99 declares no finer clock */
  gettimeofday(&t, NULL);
  return LRBCAP_CAST(uint64_t, t.tv_sec) * 1000000000u + LRBCAP_CAST(uint64_t, t.tv_usec) * 1000u;
#else
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return LRBCAP_CAST(uint64_t, t.tv_sec) * 1000000000u + LRBCAP_CAST(uint64_t, t.tv_nsec);
#endif
}

static uint64_t lrbcap_ticks(void) {
#if defined(_MSC_VER) && (defined(_M_X64) || defined(_M_IX86))
  return __rdtsc();
#elif defined(__x86_64__) || defined(__i386__)
  return __builtin_ia32_rdtsc();
#elif defined(__aarch64__) && !defined(_MSC_VER)
  uint64_t t;
  __asm__ volatile("mrs %0, cntvct_el0" : "=r"(t));
  return t;
#else
  return lrbcap_wall_ns();
#endif
}

/* ---- Numbers that several threads change. Order among them does not matter. */

#ifdef _MSC_VER
typedef volatile long long lrbcap_shared;
static uint64_t lrbcap_add(lrbcap_shared* x, uint64_t n) {
  return LRBCAP_CAST(uint64_t, _InterlockedExchangeAdd64(x, LRBCAP_CAST(long long, n)));
}
static uint64_t lrbcap_load(lrbcap_shared* x) {
  return lrbcap_add(x, 0);
}
static void lrbcap_store(lrbcap_shared* x, uint64_t n) {
  _InterlockedExchange64(x, LRBCAP_CAST(long long, n));
}
static int lrbcap_lock(lrbcap_shared* x) {
  return _InterlockedExchange64(x, 1) == 0;
}
static void lrbcap_unlock(lrbcap_shared* x) {
  _InterlockedExchange64(x, 0);
}
#else
typedef uint64_t lrbcap_shared;
static uint64_t lrbcap_add(lrbcap_shared* x, uint64_t n) {
  return __atomic_fetch_add(x, n, __ATOMIC_RELAXED);
}
static uint64_t lrbcap_load(lrbcap_shared* x) {
  return __atomic_load_n(x, __ATOMIC_RELAXED);
}
static void lrbcap_store(lrbcap_shared* x, uint64_t n) {
  __atomic_store_n(x, n, __ATOMIC_RELAXED);
}
static int lrbcap_lock(lrbcap_shared* x) {
  return __atomic_exchange_n(x, 1u, __ATOMIC_ACQUIRE) == 0;
}
static void lrbcap_unlock(lrbcap_shared* x) {
  __atomic_store_n(x, 0u, __ATOMIC_RELEASE);
}
#endif

/* ---- State. */

enum {
  LRBCAP_ROOM = 8192,        /* events of a buffer */
  LRBCAP_MOST = 14,          /* bytes of an event in the file, at most */
  LRBCAP_HEADER = 24,        /* bytes of a chunk before its content */
  LRBCAP_EVENTS_HEADER = 24, /* bytes of the content of EVTS before the events */
  LRBCAP_FLUSH_MS = 100      /* after which a query's end flushes the file */
};

typedef struct lrbcap_state { /* of a thread */
  lrbcap_buffer buffer;
  uint32_t thread, query, chunks;
  int open;               /* 1: in a query that this thread began */
  int keep;               /* 1: events of this query are written, however fast it is */
  uint64_t seen, written; /* events of this query and thread: all, and those in the file */
  uint64_t begin;         /* ticks */
  lrbcap_event events[LRBCAP_ROOM];
  unsigned char bytes[LRBCAP_HEADER + LRBCAP_EVENTS_HEADER + LRBCAP_ROOM * LRBCAP_MOST];
} lrbcap_state;

LRBCAP_THREAD_LOCAL lrbcap_buffer* lrbcap_now;
static LRBCAP_THREAD_LOCAL lrbcap_state* lrbcap_mine;

static struct {
  FILE* file;
  lrbcap_sink sink;
  void* user;
  int events, exits;                        /* 0: LRBCAP_EVENTS=0; 1: lrbcap_at_exit() is registered */
  uint32_t first, last;                     /* queries */
  uint64_t every;                           /* one query of so many is recorded */
  uint64_t limit;                           /* bytes */
  uint64_t slower, soon;                    /* ticks: of queries whose events are kept, and between flushes */
  lrbcap_shared on, lock, written, flushed; /* flushed: ticks */
  lrbcap_shared threads, queries, meshes, trees, names;
  lrbcap_shared full; /* not 0: the limit was reported */
} lrbcap_g;

/* ---- Writing. */

static void lrbcap_warn(const char* what, const char* value) {
  fprintf(stderr, "lrbscope_capture: %s: %s\n", value, what);
}

enum { LRBCAP_WRITES_NOTHING, LRBCAP_WRITES_QUERIES, LRBCAP_WRITES_EVENTS };
static int lrbcap_writes(void) {
  const uint64_t written = lrbcap_load(&lrbcap_g.written);
  if (!lrbcap_load(&lrbcap_g.on) || written >= lrbcap_g.limit + lrbcap_g.limit / 8)
    return LRBCAP_WRITES_NOTHING;
  return written < lrbcap_g.limit ? LRBCAP_WRITES_EVENTS : LRBCAP_WRITES_QUERIES;
}

/* Writes whole chunks. After a failure, nothing more is written, so that the file ends within a chunk. */
static void lrbcap_write(const void* bytes, uint64_t size) {
  int done;
  if (!lrbcap_load(&lrbcap_g.on)) return;
  lrbcap_add(&lrbcap_g.written, size);
  if (lrbcap_g.sink) {
    while (!lrbcap_lock(&lrbcap_g.lock)) {
    }
    done = lrbcap_load(&lrbcap_g.on) && lrbcap_g.sink(lrbcap_g.user, bytes, size);
    if (!done) lrbcap_store(&lrbcap_g.on, 0);
    lrbcap_unlock(&lrbcap_g.lock);
    return;
  }
  /* One fwrite per chunk: stdio does not mix those of several threads. */
  done = !ferror(lrbcap_g.file) &&
         fwrite(bytes, 1, LRBCAP_CAST(size_t, size), lrbcap_g.file) == LRBCAP_CAST(size_t, size);
  if (!done && lrbcap_load(&lrbcap_g.on)) {
    lrbcap_store(&lrbcap_g.on, 0);
    lrbcap_warn("cannot write; the recording ends here", "capture");
  }
}

static unsigned char* lrbcap_put(unsigned char* p, const void* from, uint64_t size) {
  if (size != 0) memcpy(p, from, LRBCAP_CAST(size_t, size));
  return p + size;
}
static unsigned char* lrbcap_u32(unsigned char* p, uint64_t x) {
  const uint32_t low = LRBCAP_CAST(uint32_t, x);
  return lrbcap_put(p, &low, 4);
}
static unsigned char* lrbcap_u64(unsigned char* p, uint64_t x) {
  return lrbcap_put(p, &x, 8);
}

/* A chunk begins with four letters, its version (a fifth character if it is not 1), the size of its content,
 * and the ticks now. */
static unsigned char* lrbcap_chunk(unsigned char* p, const char* letters, uint64_t size, uint64_t ticks) {
  p = lrbcap_put(p, letters, 4);
  p = lrbcap_u32(p, letters[4] ? LRBCAP_CAST(uint64_t, letters[4]) : 1u);
  p = lrbcap_u64(p, size);
  return lrbcap_u64(p, ticks);
}

/* Writes ticks beside the wall clock. */
static void lrbcap_sync(const char* letters) {
  unsigned char bytes[LRBCAP_HEADER + 8];
  const uint64_t ticks = lrbcap_ticks();
  lrbcap_u64(lrbcap_chunk(bytes, letters, 8, ticks), lrbcap_wall_ns());
  lrbcap_write(bytes, sizeof bytes);
  lrbcap_store(&lrbcap_g.flushed, ticks);
}

/* Gathers a chunk of several parts and writes it. Returns 0 if it was not written. */
static int lrbcap_gather(const char* letters, const void* const* parts, const uint64_t* sizes, int count) {
  uint64_t size = 0;
  unsigned char *all, *p;
  int i;
  if (lrbcap_writes() == LRBCAP_WRITES_NOTHING) return 0;
  for (i = 0; i < count; ++i) size += sizes[i];
  all = size < SIZE_MAX - LRBCAP_HEADER
            ? LRBCAP_CAST(unsigned char*, malloc(LRBCAP_CAST(size_t, size) + LRBCAP_HEADER))
            : NULL;
  if (!all) {
    lrbcap_warn("out of memory; the recording ends here", letters);
    lrbcap_store(&lrbcap_g.on, 0);
    return 0;
  }
  p = lrbcap_chunk(all, letters, size, lrbcap_ticks());
  for (i = 0; i < count; ++i) p = lrbcap_put(p, parts[i], sizes[i]);
  lrbcap_write(all, size + LRBCAP_HEADER);
  free(all);
  return 1;
}

/* ---- Opening and closing. */

static const char* lrbcap_setting(const char* name) {
  const char* value = getenv(name);
  return value && *value ? value : NULL;
}
static uint64_t lrbcap_setting_number(const char* name, uint64_t otherwise) {
  const char* value = lrbcap_setting(name);
  char* end;
  uint64_t number;
  if (!value) return otherwise;
  number = strtoull(value, &end, 10);
  if (*end == '\0' && *value != '-') return number;
  lrbcap_warn("expected a whole number; the variable is ignored", name);
  return otherwise;
}
static void lrbcap_setting_queries(void) {
  const char* value = lrbcap_setting("LRBCAP_QUERIES");
  char* end;
  lrbcap_g.first = 1;
  lrbcap_g.last = UINT32_MAX;
  if (!value) return;
  lrbcap_g.first = LRBCAP_CAST(uint32_t, strtoul(value, &end, 10));
  if (*end == '\0')
    lrbcap_g.last = lrbcap_g.first;
  else if (*end == '-' && end[1] != '\0')
    lrbcap_g.last = LRBCAP_CAST(uint32_t, strtoul(end + 1, &end, 10));
  else if (*end == '-')
    ++end;
  if (*end == '\0' && *value != '-' && lrbcap_g.first != 0) return;
  lrbcap_warn("expected FIRST-LAST, from 1; the variable is ignored", "LRBCAP_QUERIES");
  lrbcap_g.first = 1;
  lrbcap_g.last = UINT32_MAX;
}

/* Measures the ticks of a millisecond, in one. */
static uint64_t lrbcap_ticks_per_ms(void) {
  const uint64_t wall = lrbcap_wall_ns(), ticks = lrbcap_ticks();
  uint64_t ns;
  do ns = lrbcap_wall_ns() - wall;
  while (ns < 1000000u);
  return (lrbcap_ticks() - ticks) * 1000u / (ns / 1000u);
}

static void lrbcap_leave(void);
static void lrbcap_end_of_file(void) {
  lrbcap_leave(); /* a query that was not ended */
  if (lrbcap_load(&lrbcap_g.on)) lrbcap_sync("STOP");
  if (lrbcap_g.file && lrbcap_load(&lrbcap_g.on) && fflush(lrbcap_g.file) != 0)
    lrbcap_warn("cannot write; the end of the recording is missing", "capture");
  lrbcap_store(&lrbcap_g.on, 0);
}
/* The file stays open: a thread may still be about to write to it. */
static void lrbcap_at_exit(void) {
  if (lrbcap_g.file) lrbcap_end_of_file();
}

void lrbcap_open(const char* engine, const char* path, lrbcap_sink sink, void* user) {
  uint64_t ms, megabytes;
  const void* parts[1];
  uint64_t sizes[1];
  if (lrbcap_g.file || lrbcap_load(&lrbcap_g.on)) return;
  if (!sink && !path) path = lrbcap_setting("LRBCAP_OUT");
  if (!sink && !path) return;
  if (!sink) {
    lrbcap_g.file = fopen(path, "wb");
    if (!lrbcap_g.file) {
      lrbcap_warn("cannot open the file; nothing is recorded", path);
      return;
    }
    setvbuf(lrbcap_g.file, NULL, _IOFBF, LRBCAP_CAST(size_t, 1) << 20);
    if (!lrbcap_g.exits) lrbcap_g.exits = atexit(lrbcap_at_exit) == 0;
  }
  lrbcap_g.sink = sink;
  lrbcap_g.user = user;
  lrbcap_setting_queries();
  lrbcap_g.events = lrbcap_setting_number("LRBCAP_EVENTS", 1) != 0;
  megabytes = lrbcap_setting_number("LRBCAP_MAX_MB", 4096);
  lrbcap_g.limit = megabytes && megabytes < (UINT64_MAX >> 22) ? megabytes * 1000000u : UINT64_MAX / 2;
  lrbcap_store(&lrbcap_g.written, 0);
  lrbcap_store(&lrbcap_g.queries, 0);
  lrbcap_store(&lrbcap_g.full, 0);
  lrbcap_store(&lrbcap_g.meshes, 0);
  lrbcap_store(&lrbcap_g.trees, 0);
  lrbcap_store(&lrbcap_g.names, 0);
  lrbcap_store(&lrbcap_g.on, 1);
  {
    unsigned char header[16];
    lrbcap_u32(lrbcap_u32(lrbcap_put(header, "LRBCAP\r\n", 8), 1), 0x01020304u);
    lrbcap_write(header, sizeof header);
  }
  parts[0] = engine ? engine : "";
  sizes[0] = engine ? strlen(engine) : 0;
  lrbcap_gather("HEAD", parts, sizes, 1);
  /* Two readings of the clock: a reader of a FIFO knows the length of a tick from the first query on. */
  lrbcap_sync("SYNC");
  ms = lrbcap_ticks_per_ms();
  lrbcap_sync("SYNC");
  lrbcap_g.soon = ms * LRBCAP_FLUSH_MS;
  lrbcap_g.slower = lrbcap_setting_number("LRBCAP_SLOWER_US", 0) * ms / 1000u;
  lrbcap_every(lrbcap_setting_number("LRBCAP_EVERY", 1));
}

void lrbcap_every(uint64_t n) {
  const void* parts[1];
  uint64_t sizes[1];
  const int changes = n > 1 || lrbcap_g.every > 1;
  if (lrbcap_load(&lrbcap_g.queries)) {
    lrbcap_warn("has no effect after the first query", "LRBCAP_EVERY");
    return;
  }
  lrbcap_g.every = n > 1 ? n : 1;
  parts[0] = &lrbcap_g.every, sizes[0] = sizeof lrbcap_g.every;
  if (changes) lrbcap_gather("RATE", parts, sizes, 1);
}

void lrbcap_close(void) {
  lrbcap_end_of_file();
  if (lrbcap_g.file) fclose(lrbcap_g.file);
  lrbcap_g.file = NULL;
  lrbcap_thread_end();
}

/* ---- Descriptions. */

uint32_t lrbcap_mesh(const char* name, uint32_t n_vertices, const double* xyz, uint32_t n_triangles,
                     const uint32_t* corners) {
  uint32_t head[4];
  const void* parts[4];
  uint64_t sizes[4];
  if (lrbcap_writes() == LRBCAP_WRITES_NOTHING) return 0;
  if (!name) name = "";
  head[0] = LRBCAP_CAST(uint32_t, lrbcap_add(&lrbcap_g.meshes, 1)) + 1;
  head[1] = n_vertices;
  head[2] = n_triangles;
  head[3] = LRBCAP_CAST(uint32_t, strlen(name));
  parts[0] = head, sizes[0] = sizeof head;
  parts[1] = name, sizes[1] = head[3];
  parts[2] = xyz, sizes[2] = LRBCAP_CAST(uint64_t, n_vertices) * 24;
  parts[3] = corners, sizes[3] = LRBCAP_CAST(uint64_t, n_triangles) * 12;
  return lrbcap_gather("MESH", parts, sizes, 4) ? head[0] : 0;
}

uint32_t lrbcap_add_tree(const lrbcap_tree* tree) {
  return lrbcap_instances(NULL, tree, 0xffffffffu, NULL, NULL); /* of a mesh */
}

uint32_t lrbcap_instances(const char* name, const lrbcap_tree* tree, uint32_t n_instances, const uint32_t* bodies,
                          const double* poses) {
  static const uint32_t numbers_of[] = {0, 6, 4, 12, 10};
  const uint64_t n = tree->nodes;
  const uint32_t volume = tree->volume & ~LRBCAP_CAST(uint32_t, LRBCAP_SPLITS);
  const int floats = !tree->volumes;
  uint64_t numbers;
  uint32_t head[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  const void* parts[11];
  uint64_t sizes[11];
  if (lrbcap_writes() == LRBCAP_WRITES_NOTHING) return 0;
  if (n_instances == 0xffffffffu)
    n_instances = 0;
  else if (!name)
    name = "";
  if (n == 0 || volume == 0 || volume > LRBCAP_KDOP || (floats && !tree->float_volumes)) {
    lrbcap_warn("a tree without nodes, or without volumes of a known kind, is not recorded", "LRBCAP_TREE");
    return 0;
  }
  numbers = volume == LRBCAP_KDOP ? LRBCAP_CAST(uint64_t, tree->directions) * 2 : numbers_of[volume];
  head[0] = LRBCAP_CAST(uint32_t, lrbcap_add(&lrbcap_g.trees, 1)) + 1;
  head[1] = name ? n_instances : tree->mesh;
  head[2] = tree->replaces;
  head[3] = tree->nodes;
  head[4] = volume;
  head[5] = tree->directions;
  head[6] = (tree->ids ? 1u : 0u) | (floats ? 2u : 0u) | (tree->volume != volume ? 4u : 0u) | (name ? 8u : 0u);
  head[7] = name ? LRBCAP_CAST(uint32_t, strlen(name)) : 0;
  parts[0] = head, sizes[0] = sizeof head;
  parts[1] = tree->ids, sizes[1] = tree->ids ? n * 4 : 0;
  parts[2] = tree->first_child, sizes[2] = (n + 1) * 4;
  parts[3] = tree->child, sizes[3] = LRBCAP_CAST(uint64_t, tree->first_child[n]) * 4;
  parts[4] = tree->first_prim, sizes[4] = (n + 1) * 4;
  parts[5] = tree->prim, sizes[5] = LRBCAP_CAST(uint64_t, tree->first_prim[n]) * 4;
  if (floats)
    parts[6] = tree->float_volumes, sizes[6] = n * numbers * 4;
  else
    parts[6] = tree->volumes, sizes[6] = n * numbers * 8;
  parts[7] = tree->direction, sizes[7] = volume == LRBCAP_KDOP ? numbers * 12 : 0;
  parts[8] = bodies, sizes[8] = LRBCAP_CAST(uint64_t, n_instances) * 4;
  parts[9] = poses, sizes[9] = LRBCAP_CAST(uint64_t, n_instances) * 96;
  parts[10] = name, sizes[10] = head[7];
  return lrbcap_gather(name ? "TREE\2" : "TREE", parts, sizes, 11) ? head[0] : 0;
}

uint32_t lrbcap_name(const char* name) {
  uint32_t id;
  const void* parts[2];
  uint64_t sizes[2];
  if (lrbcap_writes() == LRBCAP_WRITES_NOTHING) return 0;
  id = LRBCAP_CAST(uint32_t, lrbcap_add(&lrbcap_g.names, 1)) + 1;
  parts[0] = &id, sizes[0] = sizeof id;
  parts[1] = name, sizes[1] = strlen(name);
  return lrbcap_gather("NAME", parts, sizes, 2) ? id : 0;
}

/* ---- Events. */

/* The difference of two numbers with its sign in the lowest bit. */
static uint32_t lrbcap_difference(uint32_t now, uint32_t before) {
  const uint32_t d = now - before;
  return (d << 1) ^ (0u - (d >> 31));
}
/* A number, seven bits per byte, from the lowest. */
static unsigned char* lrbcap_varint(unsigned char* p, uint32_t z) {
  while (z >= 128) {
    *p++ = LRBCAP_CAST(unsigned char, (z & 127) | 128);
    z >>= 7;
  }
  *p++ = LRBCAP_CAST(unsigned char, z);
  return p;
}

/* Writes the events of the buffer, or only counters and phases, and empties it. An event in the file: a byte
 * with the kind (bits 0-1), met (bit 2), and whether tests and met (bit 3) and the axis (bit 4) follow; then
 * these; then a and b as differences from the event of the same kind before. */
static void lrbcap_store_events(lrbcap_state* s, int notes_only) {
  const uint64_t count = LRBCAP_CAST(uint64_t, s->buffer.next - s->events);
  const lrbcap_event *e = s->events, *const end = s->buffer.next;
  uint32_t a[4] = {0, 0, 0, 0}, b[4] = {0, 0, 0, 0}, stored = 0;
  unsigned char* p = s->bytes + LRBCAP_HEADER + LRBCAP_EVENTS_HEADER;
  const int any = notes_only || !lrbcap_g.events ? s->buffer.notes != 0 : count != 0;
  notes_only = notes_only || !lrbcap_g.events;
  s->seen += count;
  s->buffer.next = s->events;
  s->buffer.notes = 0;
  if (!any || lrbcap_writes() != LRBCAP_WRITES_EVENTS) return;
  for (; e != end; ++e) {
    const uint32_t kind = e->what & 255, tests = e->what >> 8 & 255, met = e->what >> 16 & 255;
    const uint32_t counted = tests != 1 || met > 1, axis = e->what >> 24 != LRBCAP_NO_AXIS;
    if (notes_only && kind < LRBCAP_KIND_COUNT) continue;
    const uint32_t da = lrbcap_difference(e->a, a[kind]), db = lrbcap_difference(e->b, b[kind]);
    *p = LRBCAP_CAST(unsigned char, kind | (counted ? 8u : met * 4u) | axis << 4);
    p[1] = LRBCAP_CAST(unsigned char, tests); /* overwritten if not counted: most events need no branch */
    p[2] = LRBCAP_CAST(unsigned char, met);
    p += 1 + 2 * counted;
    *p = LRBCAP_CAST(unsigned char, e->what >> 24);
    p += axis;
    if (LRBCAP_UNLIKELY((da | db) >= 128)) {
      p = lrbcap_varint(lrbcap_varint(p, da), db);
    } else {
      *p++ = LRBCAP_CAST(unsigned char, da);
      *p++ = LRBCAP_CAST(unsigned char, db);
    }
    a[kind] = e->a;
    b[kind] = e->b;
    ++stored;
  }
  {
    const uint64_t size = LRBCAP_CAST(uint64_t, p - s->bytes);
    unsigned char* h = lrbcap_chunk(s->bytes, "EVTS", size - LRBCAP_HEADER, lrbcap_ticks());
    h = lrbcap_u32(h, s->query);
    h = lrbcap_u32(h, s->thread);
    h = lrbcap_u64(h, s->written);
    h = lrbcap_u32(h, stored);
    lrbcap_u32(h, s->chunks++);
    lrbcap_write(s->bytes, size);
  }
  s->written += stored;
}

void lrbcap_full(void) {
  lrbcap_mine->keep = 1;
  lrbcap_store_events(lrbcap_mine, 0);
}

/* Returns the state of this thread, empty and in a query; or NULL. */
static lrbcap_state* lrbcap_enter(uint32_t query) {
  lrbcap_state* s = lrbcap_mine;
  if (!s) {
    s = LRBCAP_CAST(lrbcap_state*, malloc(sizeof *s));
    if (!s) return NULL;
    s->thread = LRBCAP_CAST(uint32_t, lrbcap_add(&lrbcap_g.threads, 1)) + 1;
    s->open = 0;
    s->buffer.last = s->events + LRBCAP_ROOM - 1;
    lrbcap_mine = s;
  }
  s->query = query;
  s->chunks = 0;
  s->keep = 0;
  s->seen = s->written = 0;
  s->buffer.next = s->events;
  s->buffer.notes = 0;
  return s;
}

/* Writes what this thread recorded of the query in which it is, and leaves it. */
static void lrbcap_leave(void) {
  if (lrbcap_now) lrbcap_store_events(lrbcap_mine, 0);
  lrbcap_now = NULL;
  if (lrbcap_mine) lrbcap_mine->open = 0;
}

uint32_t lrbcap_begin(uint32_t kind, uint32_t tree_a, const double* pose_a, uint32_t tree_b,
                      const double* pose_b) {
  static const uint64_t sizes[] = {96, 64, 24, 48}; /* of the numbers of B: a pose, a ray, a point, a box */
  const uint32_t shape = kind >> 8 & 3;
  static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  unsigned char bytes[LRBCAP_HEADER + 232], *p;
  lrbcap_state* s;
  uint32_t query;
  lrbcap_leave(); /* a query that was not ended */
  if (lrbcap_writes() == LRBCAP_WRITES_NOTHING) {
    if (lrbcap_load(&lrbcap_g.on) && lrbcap_add(&lrbcap_g.full, 1) == 0)
      lrbcap_warn("the limit is reached; from here on queries are not recorded", "LRBCAP_MAX_MB");
    return 0;
  }
  query = LRBCAP_CAST(uint32_t, lrbcap_add(&lrbcap_g.queries, 1)) + 1;
  if (query < lrbcap_g.first || query > lrbcap_g.last) return 0;
  if (lrbcap_g.every > 1) { /* a hash of the number of its group chooses the query (splitmix64: Steele et al. 2014) */
    uint64_t hash = ((query - 1) / lrbcap_g.every + 1) * 0x9E3779B97F4A7C15u;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
    if ((hash ^ (hash >> 31)) % lrbcap_g.every != (query - 1) % lrbcap_g.every) return 0;
  }
  s = lrbcap_enter(query);
  if (!s) return 0;
  p = lrbcap_chunk(bytes, shape ? "QRYB\2" : "QRYB", 232, lrbcap_ticks());
  p = lrbcap_u64(p, 0);
  p = lrbcap_u32(p, query);
  p = lrbcap_u32(p, kind & 255);
  p = lrbcap_u32(p, tree_a);
  p = lrbcap_u32(p, tree_b);
  p = lrbcap_u64(p, 0);
  p = lrbcap_u32(p, s->thread);
  p = lrbcap_u32(p, shape);
  p = lrbcap_put(p, pose_a ? pose_a : identity, sizeof identity);
  memset(p, 0, sizeof identity);
  lrbcap_put(p, pose_b ? pose_b : identity, sizes[shape]);
  lrbcap_write(bytes, sizeof bytes);
  s->open = 1;
  lrbcap_now = &s->buffer;
  s->begin = lrbcap_ticks();
  return query;
}

void lrbcap_value(double lower, double upper) {
  unsigned char bytes[LRBCAP_HEADER + 24], *p;
  if (!lrbcap_mine || !lrbcap_mine->open) return;
  p = lrbcap_chunk(bytes, "VALU", 24, lrbcap_ticks());
  p = lrbcap_u64(p, lrbcap_mine->query);
  p = lrbcap_put(p, &lower, 8);
  lrbcap_put(p, &upper, 8);
  lrbcap_write(bytes, sizeof bytes);
}

void lrbcap_end(uint32_t verdict, uint64_t pairs) {
  const uint64_t now = lrbcap_ticks();
  lrbcap_state* s = lrbcap_mine;
  unsigned char bytes[LRBCAP_HEADER + 40], *p;
  if (!s || !s->open) return;
  lrbcap_now = NULL;
  s->open = 0;
  lrbcap_store_events(s, !s->keep && now - s->begin < lrbcap_g.slower);
  p = lrbcap_chunk(bytes, "QRYE", 40, now);
  p = lrbcap_u64(p, now - s->begin);
  p = lrbcap_u32(p, s->query);
  p = lrbcap_u32(p, verdict);
  p = lrbcap_u64(p, pairs);
  p = lrbcap_u64(p, s->seen);
  lrbcap_u64(p, 0);
  lrbcap_write(bytes, sizeof bytes);
  /* Flush from time to time: a crash would lose these bytes, and a reader of a FIFO would wait for them. */
  if (lrbcap_g.file && now - lrbcap_load(&lrbcap_g.flushed) > lrbcap_g.soon && lrbcap_load(&lrbcap_g.on)) {
    lrbcap_sync("SYNC");
    fflush(lrbcap_g.file); /* the next write notices a failure */
  }
}

void lrbcap_join(uint32_t query) {
  lrbcap_state* s = lrbcap_mine;
  if (s && s->open) return; /* in a query of its own */
  lrbcap_leave();
  if (query == 0 || lrbcap_writes() == LRBCAP_WRITES_NOTHING) return;
  s = lrbcap_enter(query);
  if (s) lrbcap_now = &s->buffer;
}

void lrbcap_thread_end(void) {
  lrbcap_leave();
  free(lrbcap_mine);
  lrbcap_mine = NULL;
}

#ifdef _MSC_VER
#pragma warning(pop)
#endif
#endif /* LRBCAP_IMPLEMENTATION */
#ifdef __clang__
#pragma clang diagnostic pop
#endif
#endif /* LRBSCOPE_CAPTURE_H */
