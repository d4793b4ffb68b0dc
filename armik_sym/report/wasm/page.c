/* The arm inside the page: numbers go into fixed arrays, a call computes, numbers are read from fixed arrays.
 *
 * No heap, no input or output, nothing imported. Before this text come the generated functions, and
 * PAGE_DOF, PAGE_LENGTHS (at least 1) and, for arms with a closed form, PAGE_SWIVEL and the loops of
 * compiled/c that it needs. All numbers of an arm come from outside: arms of one structure share the module.
 * Metres, radians, base frame; matrices row by row.
 */
#if defined(__wasm__)
#define PAGE_EXPORT(name) __attribute__((export_name(#name)))
#else
#define PAGE_EXPORT(name) EXPORT
#endif

/* An array, and a function that tells where it is. */
#define PAGE_ARRAY(name, size) \
  static real page_##name[size]; \
  PAGE_EXPORT(name##_at) real *name##_at(void); \
  PAGE_EXPORT(name##_at) real *name##_at(void) { return page_##name; }

PAGE_ARRAY(lengths, PAGE_LENGTHS)
PAGE_ARRAY(points, 3 * PAGE_DOF) /* the point to be drawn of each joint, in the frame the joint turns in */
PAGE_ARRAY(q, PAGE_DOF)
PAGE_ARRAY(drawn, 3 * PAGE_DOF + 12) /* points of the joints, position of the hand, its rotation */

/* q -> drawn */
PAGE_EXPORT(draw) void draw(void);
PAGE_EXPORT(draw) void draw(void) { armik_drawn(page_q, page_lengths, page_points, page_drawn); }

#ifdef PAGE_SWIVEL
PAGE_ARRAY(geometry, 46)
PAGE_ARRAY(reference, 3) /* where the elbow points at psi = 0, a unit vector */
PAGE_ARRAY(limits, 16)   /* seven lower limits, seven upper ones, offsets of shoulder and wrist */
PAGE_ARRAY(posture, 7)

/* Swivel angle of q; sines whose signs are the branches of elbow and shoulder. */
static void page_where(real where[4]) {
  armik_swivel_of(page_q, page_limits + 14, page_geometry, page_reference, where);
}

/* q, reference -> the swivel angle of q */
PAGE_EXPORT(swivel) real swivel(void);
PAGE_EXPORT(swivel) real swivel(void) {
  real where[4];
  page_where(where);
  return where[0];
}

/* q, reference, psi -> posture: the hand where q has it, on the branches of q, turns next to q. */
PAGE_EXPORT(turn_elbow) void turn_elbow(real psi);
PAGE_EXPORT(turn_elbow) void turn_elbow(real psi) {
  swivel_arm arm = {7, 2, {0}, {0}, {page_limits[14], page_limits[15]}};
  for (int j = 0; j < 7; ++j) {
    arm.lower[j] = page_limits[j];
    arm.upper[j] = page_limits[7 + j];
  }
  real where[4], curve[58], sines[2];
  page_where(where);
  const real side = where[1] < 0 ? -1.0 : 1.0;
  draw();
  armik_swivel_curve(page_drawn + 3 * PAGE_DOF, page_geometry, &side, page_reference, curve);
  const swivel_side only = {curve + 1, curve, NULL, NULL, 0, 0, 0, 0};
  const int64_t branch = (where[2] < 0 ? 2 : 0) + (sin(page_q[5] + page_limits[15]) < 0 ? 1 : 0);
  const swivel_request request = {&arm, &only, NULL, &branch, &psi, page_q, 0};
  (void)swivel_margin; /* the page compares angles with limits by itself */
  swivel_posture(&request, 0, page_posture, sines);
}
#endif
