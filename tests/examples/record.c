/* Records three queries in c.lrbcap: what lrbscope_capture.mjs and lrbscope.capture write as well. */
#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>
#include <math.h>
int main(void) {
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.2, 1}, turned[] = {0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6};
  const uint32_t corners[] = {0, 2, 1, 0, 1, 3}, first_child[] = {0, 2, 2, 2}, child[] = {1, 2};
  const uint32_t first_prim[] = {0, 0, 1, 2}, prim[] = {1, 0}, none[] = {0, 0}, all[] = {0, 2}, both[] = {0, 1};
  const double boxes[] = {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0.5, 0, 0.25, 0, 1, 1, 1};
  const double ray[] = {4, 5, 6, 0, 0, 1, 0, HUGE_VAL};
  lrbcap_tree t = {0};
  uint32_t a, b;
  LRBCAP_OPEN("engine \xc3\xa9", "c.lrbcap");
  t.mesh = LRBCAP_MESH("kn\xc3\xb6t", 4, xyz, 2, corners);
  t.nodes = 3, t.volume = LRBCAP_AABB, t.volumes = boxes;
  t.first_child = first_child, t.child = child, t.first_prim = first_prim, t.prim = prim;
  a = LRBCAP_TREE(&t);
  t.mesh = LRBCAP_MESH("shape", 4, xyz, 2, corners);
  t.nodes = 1, t.first_child = none, t.child = none, t.first_prim = all, t.prim = both;
  b = LRBCAP_TREE(&t);
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, turned, b, NULL);
  LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_NODE(2, 0, 0, LRBCAP_NO_AXIS);
  LRBCAP_NODE(1, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_PRIM(1, 0, 1);
  LRBCAP_END(LRBCAP_INTERSECTING, 1);
  LRBCAP_BEGIN(LRBCAP_SHAPE, a, NULL, 0, NULL);
  LRBCAP_NODE(4000000000u, 300, 0, LRBCAP_NO_AXIS);
  LRBCAP_NODE(1, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_END(LRBCAP_SEPARATE, 0);
  LRBCAP_RAY(LRBCAP_DISTANCE, a, turned, ray);
  LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_VALUE(0.5, 0.75);
  LRBCAP_END(LRBCAP_INTERSECTING, 0);
  LRBCAP_CLOSE();
  return 0;
}
