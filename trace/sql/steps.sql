-- Each time step: its result and number of events. In summary.json: steps.
SELECT
  EXTRACT_ARG(step.arg_set_id, 'args.time step') AS time_step,
  MAX(CASE WHEN inner_slice.name = 'result' THEN EXTRACT_ARG(inner_slice.arg_set_id, 'args.relation') END) AS relation,
  MAX(CASE WHEN inner_slice.name = 'result' THEN EXTRACT_ARG(inner_slice.arg_set_id, 'args.pairs') END) AS pairs,
  SUM(inner_slice.name = 'face test') AS face_tests,
  SUM(inner_slice.name = 'refine') AS refinements,
  SUM(inner_slice.name = 'contact') AS contacts
FROM slice AS step
JOIN slice AS inner_slice ON inner_slice.ts >= step.ts AND inner_slice.ts < step.ts + step.dur
WHERE step.category = 'step' AND step.name != 'result'
GROUP BY step.id
ORDER BY step.ts;
