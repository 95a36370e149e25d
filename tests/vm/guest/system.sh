# The script of a machine that starts a whole Debian (tests/vm/system.sh): mounts its disk, /dev/vdb, and hands over to systemd,
# which runs /vm/story as the last thing of its start (guest/story.service). What /vm has goes along in memory: the disk keeps
# only what the system itself writes.
mkdir /system
mount -t ext4 /dev/vdb /system || failed system "the disk cannot be mounted"
mount -t tmpfs tmpfs /system/run
cp -R /vm /system/run/vm
mkdir -p /system/run/systemd/system/multi-user.target.wants
cp /vm/story.service /system/run/systemd/system/
ln -s ../story.service /system/run/systemd/system/multi-user.target.wants/story.service
touch /vm/hand_over
