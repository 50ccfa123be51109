-- A construction by pass; equals construction.passes of summary.json.
SELECT
  EXTRACT_ARG(p.arg_set_id, 'args.stage') AS stage,
  COUNT(CASE WHEN e.name = 'patch' THEN 1 END) AS patches,
  COUNT(CASE WHEN e.name = 'cap' AND EXTRACT_ARG(e.arg_set_id, 'args.verdict') = 'stands' THEN 1 END) AS accepted,
  COUNT(CASE WHEN e.name = 'region' THEN 1 END) AS regions,
  COALESCE(SUM(CASE WHEN e.name = 'merged' THEN EXTRACT_ARG(e.arg_set_id, 'args.pieces') END), 0) AS pieces_merged,
  MAX(CASE WHEN e.name = 'pass end' THEN EXTRACT_ARG(e.arg_set_id, 'args.wrapper faces') END) AS faces_after
FROM slice p
JOIN slice e ON e.ts >= p.ts AND e.ts < p.ts + p.dur AND e.category IN ('cap', 'hull', 'pass')
WHERE p.category = 'pass' AND p.name != 'pass end'
GROUP BY p.id, p.arg_set_id
ORDER BY p.ts;
