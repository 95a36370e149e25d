# The points of a PLY file as dicot writes it, without what the file says about itself: sh points.sh FILE
# Their number, then the bytes: x, y, z and confidence of 4 each, three colours of 1.
points=$(sed -n 's/^element vertex //p;/^end_header/q' "$1")
echo "$points"
tail -c $((points * 19)) "$1"
