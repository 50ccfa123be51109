"""From two files to a picture of their contact: python3 contact.py A B PICTURE."""
import sys

import numpy as np
import lrbscope

a, b = lrbscope.Body.load(sys.argv[1]), lrbscope.Body.load(sys.argv[2])
pose = np.eye(4)
pose[:3, 3] = 0.01, 0, 0
answer = lrbscope.collide(a, b, pose)
print(answer.relation, len(answer.pairs), "pairs;", lrbscope.distance(a, b, pose).upper, "apart")
lrbscope.render(a, b, pose, size=(640, 480)).save(sys.argv[3])
sys.exit(answer.relation != "crossing")
