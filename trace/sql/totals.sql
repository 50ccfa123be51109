-- The totals of summary.json, over the stored events.
SELECT
  (SELECT COUNT(*) FROM slice WHERE category IN ('step', 'test', 'wrapper', 'answer', 'walk', 'point', 'phase', 'pass', 'cap', 'hull')) AS events,
  (SELECT COUNT(*) FROM slice WHERE name = 'face test') AS face_tests,
  (SELECT COUNT(*) FROM slice WHERE name = 'face test' AND EXTRACT_ARG(arg_set_id, 'args.meet') != 'disjoint') AS hits,
  (SELECT COUNT(*) FROM slice WHERE name = 'face test' AND EXTRACT_ARG(arg_set_id, 'args.meet') = 'cross') AS crossings,
  (SELECT COUNT(*) FROM slice WHERE name = 'contact') AS contacts,
  (SELECT COUNT(*) FROM slice WHERE name = 'refine' AND EXTRACT_ARG(arg_set_id, 'args.side') = 'A') AS refinements_a,
  (SELECT COUNT(*) FROM slice WHERE name = 'refine' AND EXTRACT_ARG(arg_set_id, 'args.side') = 'B') AS refinements_b,
  (SELECT COUNT(*) FROM slice WHERE name = 'coarsen' AND EXTRACT_ARG(arg_set_id, 'args.side') = 'A') AS coarsenings_a,
  (SELECT COUNT(*) FROM slice WHERE name = 'coarsen' AND EXTRACT_ARG(arg_set_id, 'args.side') = 'B') AS coarsenings_b,
  (SELECT COALESCE(SUM(EXTRACT_ARG(arg_set_id, 'args.faces added')), 0) FROM slice WHERE name = 'refine') AS faces_added;
