-- Face tests by the larger depth of the two faces. In summary.json: histograms, tests_by_depth.
SELECT
  MAX(EXTRACT_ARG(arg_set_id, 'args.depth of A'), EXTRACT_ARG(arg_set_id, 'args.depth of B')) AS depth,
  COUNT(*) AS face_tests
FROM slice
WHERE name = 'face test'
GROUP BY depth
ORDER BY depth;
